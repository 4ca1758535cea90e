#include "apps/mpi/error_consensus.h"

#include <algorithm>

#include "renderer/distributed/packing.h"

namespace gatelight::apps {
namespace {

constexpr std::chrono::seconds kOthersHave(1);

}  // namespace

renderer::Bytes packed(const RankError& fault) {
  renderer::Packer packer;
  packer.add(fault.code);
  packer.add_all(std::span<const char>(fault.line));
  return packer.take();
}

RankError unpacked(const renderer::Bytes& bytes) {
  renderer::Unpacker unpacker(bytes);
  RankError fault;
  fault.code = unpacker.read<int>();
  const std::vector<char> line = unpacker.rest<char>();
  fault.line.assign(line.begin(), line.end());
  return fault;
}

void ErrorConsensus::add(int rank, RankError fault) {
  if (!decide_at_) decide_at_ = Clock::now() + kOthersHave;
  errors_[static_cast<std::size_t>(rank)] = std::move(fault);
}

std::optional<ErrorConsensus::Verdict> ErrorConsensus::take_verdict() {
  if (!decide_at_ || taken_) return std::nullopt;
  const auto known = [](const std::optional<RankError>& fault) { return fault.has_value(); };
  const bool all = std::all_of(errors_.begin(), errors_.end(), known);
  if (!all && Clock::now() < *decide_at_) return std::nullopt;
  taken_ = true;
  const auto lowest = std::find_if(errors_.begin(), errors_.end(), known);
  const auto same = [&](const std::optional<RankError>& fault) { return fault == *lowest; };
  return Verdict{.rank = static_cast<int>(lowest - errors_.begin()),
                 .shared = all && std::all_of(errors_.begin(), errors_.end(), same),
                 .fault = **lowest};
}

}  // namespace gatelight::apps

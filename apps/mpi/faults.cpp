#include "apps/mpi/faults.h"

#include <algorithm>

#include "renderer/ranks/packing.h"

namespace gatelight::apps {
namespace {

constexpr std::chrono::seconds kOthersHave(1);

}  // namespace

renderer::Bytes packed(const Fault& fault) {
  renderer::Packer packer;
  packer.add(fault.code);
  packer.add_all(std::span<const char>(fault.line));
  return packer.take();
}

Fault unpacked(const renderer::Bytes& bytes) {
  renderer::Unpacker unpacker(bytes);
  Fault fault;
  fault.code = unpacker.read<int>();
  const std::vector<char> line = unpacker.rest<char>();
  fault.line.assign(line.begin(), line.end());
  return fault;
}

void Faults::add(int rank, Fault fault) {
  if (!decide_at_) decide_at_ = Clock::now() + kOthersHave;
  faults_[static_cast<std::size_t>(rank)] = std::move(fault);
}

std::optional<Faults::Verdict> Faults::take_verdict() {
  if (!decide_at_ || taken_) return std::nullopt;
  const auto known = [](const std::optional<Fault>& fault) { return fault.has_value(); };
  const bool all = std::all_of(faults_.begin(), faults_.end(), known);
  if (!all && Clock::now() < *decide_at_) return std::nullopt;
  taken_ = true;
  const auto lowest = std::find_if(faults_.begin(), faults_.end(), known);
  const auto same = [&](const std::optional<Fault>& fault) { return fault == *lowest; };
  return Verdict{.rank = static_cast<int>(lowest - faults_.begin()),
                 .shared = all && std::all_of(faults_.begin(), faults_.end(), same),
                 .fault = **lowest};
}

}  // namespace gatelight::apps

#include "apps/mpi/error_consensus.h"

#include <algorithm>
#include <utility>

namespace gatelight::apps {
namespace {

constexpr std::chrono::seconds kOthersHave(1);

}  // namespace

void ErrorConsensus::add(int rank, Failure fault) {
  if (!decide_at_) decide_at_ = Clock::now() + kOthersHave;
  errors_[static_cast<std::size_t>(rank)] = std::move(fault);
}

std::optional<ErrorConsensus::Verdict> ErrorConsensus::take_verdict() {
  if (!decide_at_ || taken_) return std::nullopt;
  const auto known = [](const std::optional<Failure>& fault) { return fault.has_value(); };
  const bool all = std::all_of(errors_.begin(), errors_.end(), known);
  if (!all && Clock::now() < *decide_at_) return std::nullopt;
  taken_ = true;
  const auto lowest = std::find_if(errors_.begin(), errors_.end(), known);
  const auto same = [&](const std::optional<Failure>& fault) { return fault == *lowest; };
  return Verdict{.rank = static_cast<int>(lowest - errors_.begin()),
                 .shared = all && std::all_of(errors_.begin(), errors_.end(), same),
                 .fault = **lowest};
}

}  // namespace gatelight::apps

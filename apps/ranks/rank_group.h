#pragma once
// The processes that run one command together, and their machines.

#include <functional>
#include <string>
#include <vector>

#include "renderer/distributed/ranks.h"

namespace gatelight::apps {

/// "rank 1 of 3 (host)".
std::string name_of_rank(int rank, int count, const std::string& host);

struct RankGroup {
  renderer::Ranks& ranks;
  int local_count = 1;             ///< ranks of this machine
  std::vector<std::string> hosts;  ///< one per rank; empty for a single process
  /// The ranks that name the same group; all ranks call it. Empty for a single process.
  std::function<renderer::Ranks&(int group)> split = {};
  /// Asks all other ranks to stop, as if they had received this signal. Empty for a single process.
  std::function<void(int signal)> stop_others = {};

  std::string name_of(int rank) const {
    return name_of_rank(rank, ranks.count(), hosts[static_cast<std::size_t>(rank)]);
  }
};

}  // namespace gatelight::apps

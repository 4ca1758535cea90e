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
  bool is_alone() const { return ranks.is_single(); }
  /// Whether this rank gets the pictures, writes and prints. One of the ranks does.
  bool writes() const { return ranks.first(); }

  // All ranks call the rest in the same order.

  /// The answer of the one that writes.
  bool agreed(bool mine) const { return ranks.agreed(mine); }
  /// Returns when the one that writes has come here.
  void wait_for_writer() const { ranks.agreed(0); }
  /// The signal that some rank received; 0: none.
  int signal() const;
};

}  // namespace gatelight::apps

#pragma once
// Callbacks that print when a run of several ranks ends early.

#include <functional>
#include <string>

namespace gatelight::apps {

/// Another thread calls them while the main thread computes or waits. They print and return; the ranks are
/// ended afterwards.
struct RankCallbacks {
  /// Rank 0 calls it where ranks ended with an error. `line` names the rank, unless all of them had the same
  /// error. A rank calls it itself where rank 0 does not answer.
  std::function<void(int code, const std::string& line)> on_fault;

  /// Called when no heartbeat came from a rank for this time.
  std::function<void(int rank, const std::string& host, double seconds)> on_lost;

  /// Called where another rank received a signal that ends the run.
  std::function<void(int signal)> on_stop;

  int lost_code = 1;  ///< the program's exit code where the connection is lost
};

}  // namespace gatelight::apps

#pragma once
// Rank 0's collection of the errors that ended ranks.

#include <optional>
#include <vector>

#include "apps/terminal/errors.h"
#include "base/clock.h"

namespace gatelight::apps {

class ErrorConsensus {
 public:
  explicit ErrorConsensus(int count) : errors_(static_cast<std::size_t>(count)) {}
  void add(int rank, Failure fault);

  struct Verdict {
    int rank = 0;         ///< lowest rank with an error
    bool shared = false;  ///< all ranks have the same error
    Failure fault;
  };
  /// Returns the verdict once: when all ranks have reported an error, or a second after the first report.
  std::optional<Verdict> take_verdict();

 private:
  std::vector<std::optional<Failure>> errors_;
  std::optional<Clock::time_point> decide_at_;
  bool taken_ = false;
};

}  // namespace gatelight::apps

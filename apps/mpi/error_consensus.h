#pragma once
// Rank 0's collection of the errors that ended ranks.

#include <optional>
#include <string>
#include <vector>

#include "base/clock.h"
#include "renderer/distributed/packing.h"

namespace gatelight::apps {

struct RankError {
  int code = 0;  ///< the program's exit code
  std::string line;
  bool operator==(const RankError&) const = default;
};

renderer::Bytes packed(const RankError& fault);
RankError unpacked(const renderer::Bytes& bytes);

class ErrorConsensus {
 public:
  explicit ErrorConsensus(int count) : errors_(static_cast<std::size_t>(count)) {}
  void add(int rank, RankError fault);

  struct Verdict {
    int rank = 0;         ///< lowest rank with an error
    bool shared = false;  ///< all ranks have the same error
    RankError fault;
  };
  /// Returns the verdict once: when all ranks have reported an error, or a second after the first report.
  std::optional<Verdict> take_verdict();

 private:
  std::vector<std::optional<RankError>> errors_;
  std::optional<Clock::time_point> decide_at_;
  bool taken_ = false;
};

}  // namespace gatelight::apps

#pragma once
// What rank 0 knows of the errors that ended ranks.

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "renderer/ranks/ranks.h"

namespace gatelight::apps {

struct Fault {
  int code = 0;  ///< the program's exit code
  std::string line;
  bool operator==(const Fault&) const = default;
};

renderer::Bytes packed(const Fault& fault);
Fault unpacked(const renderer::Bytes& bytes);

class Faults {
 public:
  explicit Faults(int count) : faults_(static_cast<std::size_t>(count)) {}
  void add(int rank, Fault fault);

  struct Verdict {
    int rank = 0;         ///< the lowest with a fault
    bool shared = false;  ///< all ranks have the same
    Fault fault;
  };
  /// Is there once, when all ranks have told theirs or had a second for it.
  std::optional<Verdict> take_verdict();

 private:
  using Clock = std::chrono::steady_clock;

  std::vector<std::optional<Fault>> faults_;
  std::optional<Clock::time_point> decide_at_;
  bool taken_ = false;
};

}  // namespace gatelight::apps

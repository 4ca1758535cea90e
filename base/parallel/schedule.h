#pragma once
// Records when loops and their tasks ran, so that a model can replay them on other numbers of cores
// (scripts/measure/model-cores). Costs one load of a pointer for each loop while nothing is recorded.

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace gatelight::schedule {

/// Where a loop stands in the source.
struct Place {
  const char* file;
  int line;
};

enum class Kind : std::uint8_t {
  loop,  ///< wakes the threads of the arena
  team,  ///< of a Team, whose threads wait for it
  with,  ///< tasks that run beside the lead of a Team
};

struct Event {
  Kind kind = Kind::loop;
  Place place{};
  std::int64_t begin = 0;     ///< nanoseconds since the recording began
  std::int64_t lead_end = 0;  ///< of `with`: the end of the lead
  std::int64_t end = 0;
  std::vector<std::uint32_t> tasks;  ///< nanoseconds of each, in their order
};

/// A named stretch of time.
struct Stretch {
  std::string name;
  std::int64_t begin = 0;
  std::int64_t end = 0;
};

/// Records all loops of the process from its construction on. There is one at a time.
class Recording {
 public:
  Recording();
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /// All that was recorded so far, as JSON: threads, stretches and events in the order of their ends. Call it
  /// between loops.
  std::string json(int threads) const;
};

/// Names the time from its construction to its destruction. `name` is a literal.
class Section {
 public:
  explicit Section(const char* name);
  ~Section();
  Section(const Section&) = delete;
  Section& operator=(const Section&) = delete;

 private:
  const char* name_;
  std::int64_t begin_;
};

namespace detail {

extern std::atomic<bool> recording;
std::int64_t now();

/// Records one loop. Loops inside tasks are part of the task.
class LoopRecord {
 public:
  LoopRecord(Kind kind, Place place, std::size_t tasks) {
    if (recording.load(std::memory_order_relaxed)) begin(kind, place, tasks);
  }
  ~LoopRecord() {
    if (recorded_) end();
  }
  LoopRecord(const LoopRecord&) = delete;
  LoopRecord& operator=(const LoopRecord&) = delete;

  void lead_ends() {
    if (recorded_) event_.lead_end = now();
  }
  /// Runs work(), which does the tasks first <= i < end.
  template <class Work>
  void run(std::size_t first, std::size_t end, const Work& work) {
    if (!recorded_) return work();
    const std::int64_t start = enter_task();
    work();
    leave_task(start, first, end);
  }

 private:
  void begin(Kind kind, Place place, std::size_t tasks);
  void end();
  static std::int64_t enter_task();
  void leave_task(std::int64_t start, std::size_t first, std::size_t end);

  bool recorded_ = false;
  Event event_;
};

}  // namespace detail
}  // namespace gatelight::schedule

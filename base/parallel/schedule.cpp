#include "base/parallel/schedule.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <mutex>
#include <utility>

#include "base/clock.h"

namespace gatelight::schedule {
namespace {

struct Log {
  std::mutex mutex;
  Clock::time_point start;
  std::vector<Event> events;
  std::vector<Stretch> stretches;
};

Log& the_log() {
  static Log log;
  return log;
}

/// The number of tasks that this thread is in.
thread_local int tasks_entered = 0;

const char* name_of(Kind kind) {
  switch (kind) {
    case Kind::loop:
      return "loop";
    case Kind::team:
      return "team";
    case Kind::with:
      break;
  }
  return "with";
}

}  // namespace

namespace detail {

std::atomic<bool> recording{false};

std::int64_t now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - the_log().start).count();
}

void LoopRecord::begin(Kind kind, Place place, std::size_t tasks) {
  if (tasks_entered > 0) return;
  recorded_ = true;
  event_ = {kind, place, now(), 0, 0, std::vector<std::uint32_t>(tasks, 0)};
}

void LoopRecord::end() {
  event_.end = now();
  Log& log = the_log();
  const std::lock_guard lock(log.mutex);
  log.events.push_back(std::move(event_));
}

std::int64_t LoopRecord::enter_task() {
  ++tasks_entered;
  return now();
}

void LoopRecord::leave_task(std::int64_t start, std::size_t first, std::size_t end) {
  const std::int64_t each =
      (now() - start) / static_cast<std::int64_t>(std::max<std::size_t>(end - first, 1));
  for (std::size_t i = first; i < end; ++i) event_.tasks[i] = static_cast<std::uint32_t>(each);
  --tasks_entered;
}

}  // namespace detail

Recording::Recording() {
  Log& log = the_log();
  log.events.clear();
  log.stretches.clear();
  log.start = Clock::now();
  detail::recording = true;
}

Recording::~Recording() {
  detail::recording = false;
}

std::string Recording::json(int threads) const {
  Log& log = the_log();
  const std::lock_guard lock(log.mutex);
  std::string text = fmt::format("{{\"threads\": {},\n\"stretches\": [", threads);
  for (std::size_t i = 0; i < log.stretches.size(); ++i) {
    const Stretch& s = log.stretches[i];
    text += fmt::format("{}\n[\"{}\", {}, {}]", i > 0 ? "," : "", s.name, s.begin, s.end);
  }
  text += "],\n\"events\": [";
  for (std::size_t i = 0; i < log.events.size(); ++i) {
    const Event& e = log.events[i];
    text += fmt::format("{}\n[\"{}\", \"{}:{}\", {}, {}, {}, [{}]]", i > 0 ? "," : "", name_of(e.kind),
                        e.place.file, e.place.line, e.begin, e.lead_end, e.end, fmt::join(e.tasks, ","));
  }
  return text + "]}\n";
}

Section::Section(const char* name)
    : name_(name), begin_(detail::recording.load(std::memory_order_relaxed) ? detail::now() : -1) {}

Section::~Section() {
  if (begin_ < 0) return;
  Log& log = the_log();
  const std::int64_t end = detail::now();
  const std::lock_guard lock(log.mutex);
  log.stretches.push_back({name_, begin_, end});
}

}  // namespace gatelight::schedule

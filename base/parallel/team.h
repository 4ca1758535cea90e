#pragma once
// Many short loops one after the other, by threads that wait for the next loop in place of being woken.

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>

#include "base/parallel/schedule.h"

namespace gatelight {

/// A lead runs on the calling thread, and the other threads of the arena wait for its loops. While the lead
/// goes on with something, they can do tasks of another kind (`beside`). No loop waits for a thread that has
/// not come: a single thread does everything. The loops of loops.h use the team where its lead calls them.
class Team {
 public:
  /// Runs lead(team), and returns when it is done. Throws what it throws.
  template <class Lead>
  static void run(const Lead& lead);

  /// For the lead: calls body(begin, end) for ranges that together are [0, count). How they are cut depends
  /// on the threads; the smallest has one index.
  template <class Body>
  void for_each(std::uint32_t count, const Body& body, const char* file = __builtin_FILE(),
                int line = __builtin_LINE());

  /// For the lead: runs lead(), and task(i) for each i < tasks, begun in their order. The other threads do
  /// tasks first, and take part in the loops of the lead when no task is left; when the lead is done, its
  /// thread does tasks too. So no thread is idle while there is work that it could do. Returns when all is
  /// done. Throws what either throws; where the lead does, tasks that have not begun are left out.
  template <class Lead, class Task>
  void beside(std::uint32_t tasks, const Task& task, const Lead& lead, const char* file = __builtin_FILE(),
              int line = __builtin_LINE());

  /// The team whose lead the calling thread is, outside of its loops and tasks; null: none.
  static Team* led_here() { return led_; }

 private:
  using Call = void (*)(const void* body, std::uint32_t begin, std::uint32_t end);

  /// Indices that threads take.
  class Work {
   public:
    void begin(std::uint32_t count, Call call, const void* body);
    /// Does the next indices: one over `share` of those that are left, at least one. False where none is
    /// left.
    bool take_part(std::uint32_t share);
    /// Leaves out what has not begun.
    void cancel();
    /// Waits for the indices that other threads have taken. Throws what one of them threw.
    void end();

   private:
    std::exception_ptr failure_;
    std::atomic<bool> failed_ = false;
    // A thread reads these, then takes indices by an exchange of `next_`, which fails where the work has
    // changed.
    std::atomic<Call> call_ = nullptr;
    std::atomic<const void*> body_ = nullptr;
    std::atomic<std::uint32_t> count_ = 0;
    alignas(64) std::atomic<std::uint64_t> next_ = 0;  ///< number of the work << 32 | first index not taken
    alignas(64) std::atomic<std::uint32_t> done_ = 0;  ///< indices that are done
  };

  /// Another leader of this thread, or none, for some time.
  class Leading {
   public:
    explicit Leading(Team* team) : before_(led_) { led_ = team; }
    ~Leading() { led_ = before_; }
    Leading(const Leading&) = delete;
    Leading& operator=(const Leading&) = delete;

   private:
    Team* before_;
  };

  explicit Team(int threads) : threads_(static_cast<std::uint32_t>(threads)) {}
  /// Takes part in the work until the lead ends.
  void help();
  template <class Run>
  static void begin(Work& work, std::uint32_t count, const Run& run);

  static thread_local Team* led_;
  const std::uint32_t threads_;
  std::atomic<bool> ended_ = false;
  Work loop_;
  Work tasks_;
};

template <class Run>
void Team::begin(Work& work, std::uint32_t count, const Run& run) {
  work.begin(
      count,
      [](const void* body, std::uint32_t begin, std::uint32_t end) {
        (*static_cast<const Run*>(body))(begin, end);
      },
      &run);
}

template <class Body>
void Team::for_each(std::uint32_t count, const Body& body, const char* file, int line) {
  schedule::detail::LoopRecord record(schedule::Kind::team, {file, line}, count);
  const Leading none(nullptr);
  const auto run = [&](std::uint32_t begin, std::uint32_t end) {
    record.run(begin, end, [&] { body(begin, end); });
  };
  if (count == 0) return;
  if (threads_ == 1) return run(0, count);
  begin(loop_, count, run);
  while (loop_.take_part(2 * threads_)) {
  }
  loop_.end();
}

template <class Lead, class Task>
void Team::beside(std::uint32_t tasks, const Task& task, const Lead& lead, const char* file, int line) {
  schedule::detail::LoopRecord record(schedule::Kind::with, {file, line}, tasks);
  const auto run = [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) record.run(i, i + 1, [&] { task(std::size_t{i}); });
  };
  if (threads_ > 1) begin(tasks_, tasks, run);
  try {
    lead();
  } catch (...) {
    if (threads_ > 1) tasks_.cancel();
    throw;
  }
  record.lead_ends();
  const Leading none(nullptr);
  if (threads_ == 1) return run(0, tasks);
  while (tasks_.take_part(~0u)) {
  }
  tasks_.end();
}

template <class Lead>
void Team::run(const Lead& lead) {
  const int threads = tbb::this_task_arena::max_concurrency();
  Team team(threads);
  tbb::task_group helpers;
  for (int h = 1; h < threads; ++h) helpers.run([&] { team.help(); });
  try {
    const Leading leading(&team);
    lead(team);
  } catch (...) {
    team.ended_ = true;
    helpers.wait();
    throw;
  }
  team.ended_ = true;
  helpers.wait();
}

}  // namespace gatelight

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

/// A lead runs on the calling thread, and its loops are shared with the other threads of the arena. These do
/// other tasks first, if there are any, and take part in the loops of the lead when no task is left; when the
/// lead is done, its thread does tasks too. So both kinds of work go on at once, and no thread is idle while
/// there is work that it could do. No thread waits for one that has not come: a single thread does
/// everything.
class Team {
 public:
  /// Runs lead(team), and task(i) for each i < tasks, begun in their order. Returns when all is done. Throws
  /// what either throws; the tasks that have not begun are left out then.
  template <class Lead, class Task>
  static void run(const Lead& lead, std::size_t tasks, const Task& task, const char* file = __builtin_FILE(),
                  int line = __builtin_LINE());

  /// For the lead: calls body(begin, end) for ranges that together are [0, count). How they are cut depends
  /// on the threads; the smallest has one index.
  template <class Body>
  void for_each(std::uint32_t count, const Body& body, const char* file = __builtin_FILE(),
                int line = __builtin_LINE());

 private:
  using Call = void (*)(const void* body, std::uint32_t begin, std::uint32_t end);

  explicit Team(int threads) : threads_(static_cast<std::uint32_t>(threads)) {}
  /// Does a part of the present loop. False where none is left.
  bool take_part();
  /// Takes part in loops until the lead ends.
  void help();
  void begin_loop(std::uint32_t count, Call call, const void* body);
  void end_loop();
  void end() { ended_.store(true, std::memory_order_release); }

  const std::uint32_t threads_;
  std::exception_ptr failure_;
  std::atomic<bool> failed_ = false;
  std::atomic<bool> ended_ = false;
  // The present loop. A helper reads it, then takes indices by an exchange of `next_`, which fails where the
  // loop has changed meanwhile.
  std::atomic<Call> call_ = nullptr;
  std::atomic<const void*> body_ = nullptr;
  std::atomic<std::uint32_t> count_ = 0;
  alignas(64) std::atomic<std::uint64_t> next_ = 0;  ///< number of the loop << 32 | first index not taken
  alignas(64) std::atomic<std::uint32_t> done_ = 0;  ///< indices that are done
};

template <class Body>
void Team::for_each(std::uint32_t count, const Body& body, const char* file, int line) {
  schedule::detail::LoopRecord record(schedule::Kind::team, {file, line}, count);
  const auto run = [&](std::uint32_t begin, std::uint32_t end) {
    record.run(begin, end, [&] { body(begin, end); });
  };
  if (count == 0) return;
  if (threads_ == 1) return run(0, count);
  begin_loop(
      count,
      [](const void* context, std::uint32_t begin, std::uint32_t end) {
        (*static_cast<const decltype(run)*>(context))(begin, end);
      },
      &run);
  while (take_part()) {
  }
  end_loop();
}

template <class Lead, class Task>
void Team::run(const Lead& lead, std::size_t tasks, const Task& task, const char* file, int line) {
  schedule::detail::LoopRecord record(schedule::Kind::with, {file, line}, tasks);
  const int threads = tbb::this_task_arena::max_concurrency();
  Team team(threads);
  std::atomic<std::size_t> next = 0;
  const auto do_tasks = [&] {
    for (std::size_t i = next++; i < tasks; i = next++) record.run(i, i + 1, [&] { task(i); });
  };
  tbb::task_group helpers;
  for (int h = 1; h < threads; ++h) {
    helpers.run([&] {
      do_tasks();
      team.help();
    });
  }
  try {
    lead(team);
    record.lead_ends();
    team.end();
    do_tasks();
  } catch (...) {
    next = tasks;
    team.end();
    helpers.cancel();
    helpers.wait();
    throw;
  }
  helpers.wait();
}

}  // namespace gatelight

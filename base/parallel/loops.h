#pragma once
// Loops over the threads of the caller's arena, or of the team that it leads. They split their work in a way
// that does not depend on the number of threads.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/parallel/schedule.h"
#include "base/parallel/team.h"

namespace gatelight {

/// Calls body(i) for each i < count. Each is a task, so it should take some microseconds or more.
template <class Body>
void for_each(std::size_t count, const Body& body, const char* file = __builtin_FILE(),
              int line = __builtin_LINE()) {
  if (Team* const team = Team::led_here()) {
    return team->for_each(
        static_cast<std::uint32_t>(count),
        [&](std::uint32_t begin, std::uint32_t end) {
          for (std::size_t i = begin; i < end; ++i) body(i);
        },
        file, line);
  }
  schedule::detail::LoopRecord record(schedule::Kind::loop, {file, line}, count);
  const auto run = [&](std::size_t i) { record.run(i, i + 1, [&] { body(i); }); };
  if (count == 1) return run(0);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, count, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) run(i);
      },
      tbb::simple_partitioner());
}

/// Calls body(begin, end) for ranges of `grain`, the last may be shorter, which together are [0, count).
template <class Body>
void for_each_range(std::size_t count, std::size_t grain, const Body& body,
                    const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
  for_each((count + grain - 1) / grain,
           [&](std::size_t i) { body(i * grain, std::min(count, (i + 1) * grain)); }, file, line);
}

}  // namespace gatelight

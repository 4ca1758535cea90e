#pragma once
// Loops over the threads of the caller's arena, or of the team that it leads. They split their work in a way
// that does not depend on the number of threads.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/parallel/team.h"

namespace gatelight {

/// Calls body(i) for each i < count. Each is a task, so it should take some microseconds or more.
template <class Body>
void for_each(std::size_t count, const Body& body) {
  if (Team* const team = Team::led_here()) {
    return team->for_each(static_cast<std::uint32_t>(count), [&](std::uint32_t begin, std::uint32_t end) {
      for (std::size_t i = begin; i < end; ++i) body(i);
    });
  }
  if (count == 1) {
    body(std::size_t{0});
    return;
  }
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, count, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
      },
      tbb::simple_partitioner());
}

/// Calls body(begin, end) for ranges of `grain`, the last may be shorter, which together are [0, count).
template <class Body>
void for_each_range(std::size_t count, std::size_t grain, const Body& body) {
  for_each((count + grain - 1) / grain,
           [&](std::size_t i) { body(i * grain, std::min(count, (i + 1) * grain)); });
}

}  // namespace gatelight

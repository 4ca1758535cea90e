#pragma once

#include <tbb/parallel_for.h>

#include <atomic>
#include <exception>
#include <vector>

#include "scene/gltf/error.h"

namespace gatelight::scene::gltf {

/// Calls load(i, own warnings) for every i below count, in parallel. Rethrows the exception of the lowest
/// index, so that the message does not depend on the schedule.
template <typename Load>
void load_each(std::size_t count, const Load& load, Warnings& warnings) {
  std::vector<Warnings> own(count);
  std::vector<std::exception_ptr> errors(count);
  std::atomic<std::size_t> first_error{count};
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    if (i > first_error) return;
    try {
      load(i, own[i]);
    } catch (...) {
      errors[i] = std::current_exception();
      std::size_t first = first_error;
      while (i < first && !first_error.compare_exchange_weak(first, i)) {
      }
    }
  });
  if (first_error < count) std::rethrow_exception(errors[first_error]);
  for (const Warnings& w : own) warnings.merge(w);
}

}  // namespace gatelight::scene::gltf

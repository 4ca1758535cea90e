#pragma once
// Seconds spent in Embree, measured around whole batches of rays.

#include <chrono>

#include "renderer/settings/statistics.h"

namespace gatelight::renderer {

class TraceTimer {
 public:
  explicit TraceTimer(RayCounts& counts) : counts_(counts), start_(std::chrono::steady_clock::now()) {}
  ~TraceTimer() {
    counts_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  TraceTimer(const TraceTimer&) = delete;
  TraceTimer& operator=(const TraceTimer&) = delete;

 private:
  RayCounts& counts_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace gatelight::renderer

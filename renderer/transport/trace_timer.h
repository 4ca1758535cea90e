#pragma once
// Seconds spent in Embree, measured around whole batches of rays.

#include "renderer/machine/clock.h"
#include "renderer/settings/statistics.h"

namespace gatelight::renderer {

class TraceTimer {
 public:
  explicit TraceTimer(RayCounts& counts) : counts_(counts) {}
  ~TraceTimer() { counts_.seconds += seconds_since(start_); }
  TraceTimer(const TraceTimer&) = delete;
  TraceTimer& operator=(const TraceTimer&) = delete;

 private:
  RayCounts& counts_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace gatelight::renderer

#include "apps/mpi/deadline.h"

#include <chrono>
#include <cstdlib>
#include <utility>

namespace gatelight::apps {

Deadline::Deadline(double seconds, std::function<void()> late)
    : thread_([this, seconds, late = std::move(late)] {
        std::unique_lock lock(mutex_);
        const std::chrono::duration<double> time(seconds);
        if (!changed_.wait_for(lock, time, [&] { return over_; })) late();
      }) {}

Deadline::~Deadline() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

int rank_of_launcher() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK", "SLURM_PROCID"}) {
    if (const char* const rank = std::getenv(name)) return std::atoi(rank);
  }
  return 0;
}

}  // namespace gatelight::apps

#pragma once
// A deadline for the MPI calls that wait for other ranks and cannot be polled: initialisation and
// finalisation.

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace gatelight::apps {

/// Calls `late` on another thread after `seconds`, unless the object is destroyed before.
class Deadline {
 public:
  Deadline(double seconds, std::function<void()> late);
  ~Deadline();
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool over_ = false;
  std::thread thread_;
};

/// Rank of this process in the launcher's environment variables, which exist before MPI is initialised; 0
/// where there is none.
int rank_of_launcher();

}  // namespace gatelight::apps

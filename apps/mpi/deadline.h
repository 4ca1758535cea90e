#pragma once
// An end for calls of MPI that wait for other ranks and cannot be asked whether they are done: its start and
// its end.

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace gatelight::apps {

/// Calls a function on another thread, unless it is gone before.
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

/// This process's rank as its launcher tells it, before MPI does; 0 where it does not.
int rank_of_launcher();

}  // namespace gatelight::apps

#pragma once
// Ranks by MPI: processes that mpirun started, on one machine or on many.

#include <exception>
#include <memory>
#include <optional>
#include <vector>

#include "apps/mpi/mpi_collectives.h"
#include "apps/mpi/mpi_world.h"
#include "apps/mpi/progress_thread.h"

namespace gatelight::apps {

/// At most one object at a time in a process. A process that mpirun has not started is the only rank.
class MpiRanks {
 public:
  /// Starts MPI. Throws MpiError where it cannot be used. A rank without a heartbeat for `silence_seconds`
  /// is lost, which ends the run.
  MpiRanks(int* argc, char*** argv, double silence_seconds);
  /// Calls end(). Ends all ranks where an exception is in flight or end() fails.
  ~MpiRanks();
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  MpiCollectives& all() { return all_; }

  /// The ranks that name the same group. This object owns them. All ranks call it at about the same time.
  MpiCollectives& split(int group);

  /// Asks all other ranks to stop, as if they had received this signal.
  void stop_others(int signal) { progress_thread_->stop_others(signal); }

  /// This rank, one of several, ends with an error. Where all ranks report the same error within a second, it
  /// is printed once, and each rank returns and must end with the code. Otherwise all ranks end here.
  void fail(const Failure& failure);

  /// All ranks call it when they are done, or when fail() has returned. It waits for the others and stops
  /// MPI.
  void end();

 private:
  bool exchanges_over();

  double silence_;
  MpiWorld world_;
  MpiCollectives all_{world_};
  std::vector<std::unique_ptr<MpiCollectives>> groups_;  ///< that were split off
  std::optional<ProgressThread> progress_thread_;        ///< empty for a single process
  std::optional<int> fault_;                             ///< exit code of the error
  bool ended_ = false;
  int exceptions_ = std::uncaught_exceptions();
};

}  // namespace gatelight::apps

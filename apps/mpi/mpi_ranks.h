#pragma once
// Ranks by MPI: processes that mpirun started, on one machine or on many.

#include <memory>
#include <string>
#include <vector>

#include "apps/mpi/callbacks.h"
#include "renderer/distributed/ranks.h"

namespace gatelight::apps {

/// At most one object at a time in a process. A process that mpirun has not started is the only rank.
class MpiRanks {
 public:
  using Callbacks = RankCallbacks;

  /// Starts MPI. Throws MpiError where it cannot be used. A rank without a heartbeat for `silence_seconds`
  /// is lost, which ends the run.
  MpiRanks(int* argc, char*** argv, Callbacks callbacks, double silence_seconds = 20.0);
  /// Calls end(). Ends all ranks where an exception is in flight or end() fails.
  ~MpiRanks();
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  renderer::Ranks& all();
  int local_count() const;  ///< ranks of this machine
  const std::vector<std::string>& hosts() const;

  /// The ranks that name the same group. This object owns them. All ranks call it at about the same time.
  renderer::Ranks& split(int group);

  /// Asks all other ranks to stop, as if they had received this signal.
  void stop_others(int signal);

  /// This rank ends with an error. Where all ranks report the same error within a second, the line is printed
  /// once, and each rank returns and must end with the code. Otherwise all ranks end here.
  void fail(int code, const std::string& line);

  /// All ranks call it when they are done, or when fail() has returned. It waits for the others and stops
  /// MPI.
  void end();

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace gatelight::apps

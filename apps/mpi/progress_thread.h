#pragma once
// The thread that serves MPI while the other threads compute: it advances exchanges, sends and receives
// heartbeats and errors, and ends all ranks where one is lost.

#include <atomic>
#include <thread>
#include <vector>

#include "apps/mpi/error_consensus.h"
#include "apps/mpi/exchanges.h"
#include "apps/mpi/heartbeats.h"
#include "apps/mpi/mailbox.h"
#include "apps/mpi/mpi_world.h"

namespace gatelight::apps {

class ProgressThread {
 public:
  ProgressThread(const MpiWorld& world, Exchanges& exchanges, double silence_seconds);
  /// Call stop() before.
  ~ProgressThread() = default;
  ProgressThread(const ProgressThread&) = delete;
  ProgressThread& operator=(const ProgressThread&) = delete;

  /// Advances these exchanges too. The caller holds the mutex.
  void serve(Exchanges& exchanges) { exchanges_.push_back(&exchanges); }

  /// Asks all other ranks to stop, as if they had received this signal.
  void stop_others(int signal);

  /// Reports the error to rank 0. Returns where all ranks have the same error, else the program ends here.
  void fail(const Failure& fault);

  /// Returns when no rank needs this one any more. All ranks call it.
  void stop();

  /// Prints this rank's error, unless another thread is ending the program, and ends all ranks.
  [[noreturn]] void abort(const Failure& fault) { abort(fault, world_.rank); }

 private:
  void run();
  bool step();
  void receive(const Mailbox::Message& message);
  void reach_consensus(const ErrorConsensus::Verdict& verdict);
  [[noreturn]] void abort(Failure fault, int rank);
  [[noreturn]] void end_all(const Failure& failure);

  const MpiWorld& world_;
  std::vector<Exchanges*> exchanges_;
  Mailbox mailbox_;
  Heartbeats heartbeats_;
  ErrorConsensus errors_;
  std::atomic<bool> may_leave_ = false;  // after an error that all ranks have
  bool stopping_ = false;
  std::atomic_flag aborting_;
  std::thread thread_;
};

}  // namespace gatelight::apps

#pragma once
// The thread that looks after the connection while the others compute: it moves gatherings on, sends and
// receives heartbeats and faults, and ends all ranks where one is lost.

#include <atomic>
#include <functional>
#include <string>
#include <thread>

#include "apps/mpi/callbacks.h"
#include "apps/mpi/faults.h"
#include "apps/mpi/gatherings.h"
#include "apps/mpi/heartbeats.h"
#include "apps/mpi/mailbox.h"
#include "apps/mpi/mpi_world.h"

namespace gatelight::apps {

class Attendant {
 public:
  Attendant(const MpiWorld& world, Gatherings& gatherings, RankCallbacks callbacks, double silence_seconds);
  /// After stop().
  ~Attendant() = default;
  Attendant(const Attendant&) = delete;
  Attendant& operator=(const Attendant&) = delete;

  /// Tells the fault to rank 0. Returns where all ranks have the same, else the program ends here.
  void fail(const Fault& fault);

  /// Returns when no rank needs this one any more. All ranks call it.
  void stop();

  /// Prints this rank's fault, unless another thread is ending the program, and ends all ranks.
  [[noreturn]] void abort(const Fault& fault);

 private:
  void run();
  bool step();
  void receive(const Mailbox::Message& message);
  void settle(const Faults::Verdict& verdict);
  [[noreturn]] void abort(int code, const std::function<void()>& print);

  const MpiWorld& world_;
  Gatherings& gatherings_;
  const RankCallbacks callbacks_;
  Mailbox mailbox_;
  Heartbeats heartbeats_;
  Faults faults_;
  std::atomic<bool> may_leave_ = false;  // after a fault that all ranks have
  bool stopping_ = false;
  std::atomic_flag aborting_;
  std::thread thread_;
};

}  // namespace gatelight::apps

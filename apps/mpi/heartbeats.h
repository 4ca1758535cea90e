#pragma once
// Rank 0 and each other rank tell each other once a second that they live. A process that hangs, is stopped
// or lost its network sends nothing, and MPI would wait for it forever.

#include <chrono>
#include <optional>
#include <vector>

#include "apps/mpi/mailbox.h"
#include "apps/mpi/mpi_world.h"

namespace gatelight::apps {

class Heartbeats {
 public:
  static constexpr int kTag = 1;

  /// Rank 0 gives up others after `silence` seconds. They give it up later, because it may be about to end
  /// them with a better reason.
  Heartbeats(const MpiWorld& world, Mailbox& mailbox, double silence);

  void receive(const Mailbox::Message& beat);

  struct Lost {
    int rank = 0;
    double seconds = 0.0;  ///< without a sign of life
  };
  /// Sends what is due. Tells who is silent for too long.
  std::optional<Lost> step();

  /// This rank expects and needs nothing more. Its last beat says so.
  void say_goodbye();
  bool all_said_goodbye() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Peer {
    int rank = 0;
    double silent = 0.0;  // seconds
    bool left = false;
  };
  void send(int to, bool last);

  Mailbox& mailbox_;
  std::vector<Peer> peers_;
  double silence_ = 0.0;
  bool leaving_ = false;
  Clock::time_point last_step_;
  double until_beat_ = 0.0;  // seconds
};

}  // namespace gatelight::apps

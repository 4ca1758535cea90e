#pragma once
// Rank 0 and each other rank exchange heartbeats once a second. A process that hangs, is stopped or lost its
// network sends nothing, and MPI would wait for it forever.

#include <optional>
#include <vector>

#include "apps/mpi/mailbox.h"
#include "apps/mpi/mpi_world.h"
#include "base/clock.h"

namespace gatelight::apps {

class Heartbeats {
 public:
  static constexpr int kTag = 1;

  /// Rank 0 gives up other ranks after `silence` seconds. They give up rank 0 later, because it may be about
  /// to end them with a better message.
  Heartbeats(const MpiWorld& world, Mailbox& mailbox, double silence);

  void receive(const Mailbox::Message& beat);

  struct Lost {
    int rank = 0;
    double seconds = 0.0;  ///< without a heartbeat
  };
  /// Sends the heartbeats that are due. Returns a rank that is silent for too long.
  std::optional<Lost> step();

  /// Sends the last heartbeats, which say that this rank needs no more messages.
  void announce_exit();
  bool all_said_goodbye() const;

 private:
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

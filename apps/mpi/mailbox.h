#pragma once
// Small messages between ranks, sent and received without waiting. The caller holds the mutex.

#include <optional>
#include <vector>

#include "apps/mpi/mpi_calls.h"
#include "renderer/distributed/ranks.h"

namespace gatelight::apps {

class Mailbox {
 public:
  explicit Mailbox(MPI_Comm comm) : comm_(comm) {}

  struct Message {
    int rank = 0;
    int tag = 0;
    renderer::Bytes bytes;
  };
  void send(int to, int tag, renderer::Bytes bytes);
  /// Returns the next message that has arrived, if any.
  std::optional<Message> receive();

  /// Whether a message with this rank and tag is still being sent.
  bool sending(int to, int tag) const;
  /// Frees the memory of messages that have been sent.
  void forget_sent();
  bool sending_any();

 private:
  struct Sending {
    Message message;
    Requests request{kNoRequest};
  };

  MPI_Comm comm_;
  std::vector<Sending> out_;
  Message in_;
  Requests receiving_;  ///< empty: nothing is being received
};

}  // namespace gatelight::apps

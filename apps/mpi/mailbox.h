#pragma once
// Small messages between ranks, sent and received in passing. The caller holds the mutex.

#include <optional>
#include <vector>

#include "apps/mpi/mpi_calls.h"
#include "renderer/ranks/ranks.h"

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
  /// The next one that is there.
  std::optional<Message> receive();

  /// Whether such a message is still on its way out.
  bool sending(int to, int tag) const;
  /// Messages that are out need no memory.
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

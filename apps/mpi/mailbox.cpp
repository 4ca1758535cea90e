#include "apps/mpi/mailbox.h"

#include <algorithm>
#include <utility>

namespace gatelight::apps {

void Mailbox::send(int to, int tag, renderer::Bytes bytes) {
  Sending& sending =
      out_.emplace_back(Sending{.message = {.rank = to, .tag = tag, .bytes = std::move(bytes)}});
  const renderer::Bytes& data = sending.message.bytes;
  check(MPI_Isend(data.data(), static_cast<int>(data.size()), kByte, to, tag, comm_, sending.request.data()),
        "MPI_Isend");
}

std::optional<Mailbox::Message> Mailbox::receive() {
  if (receiving_.empty()) {
    int there = 0;
    MPI_Status status;
    check(MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, comm_, &there, &status), "MPI_Iprobe");
    if (there == 0) return std::nullopt;
    int length = 0;
    check(MPI_Get_count(&status, kByte, &length), "MPI_Get_count");
    in_ = {.rank = status.MPI_SOURCE, .tag = status.MPI_TAG, .bytes = {}};
    in_.bytes.resize(static_cast<std::size_t>(length));
    receiving_.push_back(kNoRequest);
    check(MPI_Irecv(in_.bytes.data(), length, kByte, in_.rank, in_.tag, comm_, receiving_.data()),
          "MPI_Irecv");
  }
  if (!all_done(receiving_)) return std::nullopt;
  receiving_.clear();
  return std::exchange(in_, {});
}

bool Mailbox::sending(int to, int tag) const {
  return std::any_of(out_.begin(), out_.end(), [&](const Sending& sending) {
    return sending.message.rank == to && sending.message.tag == tag;
  });
}

bool Mailbox::sending_any() {
  forget_sent();
  return !out_.empty();
}

void Mailbox::forget_sent() {
  std::vector<Sending> rest;
  for (Sending& sending : out_) {
    if (!all_done(sending.request)) rest.push_back(std::move(sending));
  }
  out_ = std::move(rest);
}

}  // namespace gatelight::apps

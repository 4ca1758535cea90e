#include "apps/mpi/exchanges.h"

#include <cstdint>
#include <numeric>
#include <utility>

#include "apps/mpi/mpi_calls.h"

namespace gatelight::apps {

using renderer::Bytes;

Exchange::Exchange(const MpiGroup& group, std::vector<Bytes> outgoing)
    : group_(group),
      outgoing_(std::move(outgoing)),
      incoming_(static_cast<std::size_t>(group.count)),
      incoming_sizes_(incoming_.size()) {
  for (int rank = 0; rank < group.count; ++rank) outgoing_sizes_.push_back(bytes_to(rank).size());
}

void Exchange::advance() {
  try {
    if (!over() && all_done(requests_)) next_step();
  } catch (...) {
    error_ = std::current_exception();
    step_ = Step::over;
  }
}

std::uint64_t Exchange::bytes_sent() const {
  const std::uint64_t own = outgoing_sizes_[static_cast<std::size_t>(group_.rank)];
  return std::accumulate(outgoing_sizes_.begin(), outgoing_sizes_.end(), std::uint64_t{0}) - own;
}

std::vector<Bytes> Exchange::take() {
  if (error_) std::rethrow_exception(error_);
  return std::move(incoming_);
}

Bytes& Exchange::bytes_to(int rank) {
  return outgoing_.size() == 1 ? outgoing_[0] : outgoing_[static_cast<std::size_t>(rank)];
}

void Exchange::next_step() {
  requests_.clear();
  switch (step_) {
    case Step::begin:
      requests_.push_back(kNoRequest);
      check(MPI_Ialltoall(outgoing_sizes_.data(), 1, kUint64, incoming_sizes_.data(), 1, kUint64,
                          group_.exchanges, requests_.data()),
            "MPI_Ialltoall");
      step_ = Step::sizes;
      break;
    case Step::sizes:
      begin_bytes();
      step_ = Step::bytes;
      break;
    case Step::bytes:
      incoming_[static_cast<std::size_t>(group_.rank)] = std::move(bytes_to(group_.rank));
      step_ = Step::over;
      break;
    case Step::over:
      break;
  }
}

/// Each rank begins with the next rank, so that they do not all send to the same one.
void Exchange::begin_bytes() {
  for (int i = 1; i < group_.count; ++i) {
    const int from = (group_.rank + group_.count - i) % group_.count;
    Bytes& theirs = incoming_[static_cast<std::size_t>(from)];
    theirs.resize(incoming_sizes_[static_cast<std::size_t>(from)]);
    begin_receive(group_.exchanges, from, theirs, requests_);
  }
  for (int i = 1; i < group_.count; ++i) {
    const int to = (group_.rank + i) % group_.count;
    begin_send(group_.exchanges, to, bytes_to(to), requests_);
  }
}

std::shared_ptr<Exchange> Exchanges::begin(std::vector<Bytes> outgoing) {
  auto exchange = std::make_shared<Exchange>(group_, std::move(outgoing));
  waiting_.push_back(exchange);
  if (waiting_.size() == 1) advance();
  return exchange;
}

void Exchanges::advance() {
  if (waiting_.empty()) return;
  Exchange& first = *waiting_.front();
  first.advance();
  if (!first.over()) return;
  if (first.failed()) failed_.push_back(waiting_.front());
  waiting_.pop_front();
}

}  // namespace gatelight::apps

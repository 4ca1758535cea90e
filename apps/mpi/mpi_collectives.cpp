#include "apps/mpi/mpi_collectives.h"

#include <cassert>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <utility>

#include "apps/mpi/mpi_calls.h"
#include "base/clock.h"

namespace gatelight::apps {
namespace {

using renderer::Bytes;

std::size_t index(int rank) {
  return static_cast<std::size_t>(rank);
}

/// Adds its lifetime to a counter.
class WaitingTime {
 public:
  explicit WaitingTime(std::atomic<std::int64_t>& nanoseconds) : nanoseconds_(nanoseconds) {}
  ~WaitingTime() {
    nanoseconds_ += std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin_).count();
  }
  WaitingTime(const WaitingTime&) = delete;
  WaitingTime& operator=(const WaitingTime&) = delete;

 private:
  std::atomic<std::int64_t>& nanoseconds_;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace

std::vector<Bytes> MpiCollectives::exchange(std::vector<Bytes> outgoing) {
  assert(outgoing.size() == index(count()));
  if (is_single()) return outgoing;
  const WaitingTime time(waiting_);
  struct Exchange {
    std::vector<Bytes> outgoing, incoming;
    std::vector<std::uint64_t> outgoing_sizes, incoming_sizes;
    Requests requests{kNoRequest};
  };
  const MpiMemory<Exchange> all;
  all->outgoing = std::move(outgoing);
  Bytes own = std::exchange(all->outgoing[index(rank())], {});
  for (const Bytes& bytes : all->outgoing) {
    all->outgoing_sizes.push_back(bytes.size());
    bytes_sent_ += bytes.size();
  }
  all->incoming_sizes.resize(index(count()));
  {
    const std::lock_guard lock(mpi_mutex());
    check(MPI_Ialltoall(all->outgoing_sizes.data(), 1, kUint64, all->incoming_sizes.data(), 1, kUint64,
                        group_.data, all->requests.data()),
          "MPI_Ialltoall");
  }
  wait_for(all->requests);

  all->requests.clear();
  for (const std::uint64_t size : all->incoming_sizes) all->incoming.emplace_back(size);
  {
    const std::lock_guard lock(mpi_mutex());
    for (int other = 0; other < count(); ++other)
      begin_receive(group_.data, other, all->incoming[index(other)], all->requests);
    // Each rank begins with the next rank, so that they do not all send to the same one.
    for (int i = 1; i < count(); ++i) {
      const int to = (rank() + i) % count();
      begin_send(group_.data, to, all->outgoing[index(to)], all->requests);
    }
  }
  wait_for(all->requests);
  all->incoming[index(rank())] = std::move(own);
  return std::move(all->incoming);
}

void MpiCollectives::broadcast(Bytes& bytes) {
  if (is_single()) return;
  const WaitingTime time(waiting_);
  struct Broadcast {
    Bytes bytes;
    std::uint64_t size = 0;
    Requests requests;
  };
  const MpiMemory<Broadcast> all;
  all->bytes = std::move(bytes);
  all->size = all->bytes.size();
  {
    const std::lock_guard lock(mpi_mutex());
    begin_broadcast(group_.data, std::as_writable_bytes(std::span(&all->size, 1)), all->requests);
  }
  wait_for(all->requests);

  all->requests.clear();
  all->bytes.resize(all->size);
  {
    const std::lock_guard lock(mpi_mutex());
    begin_broadcast(group_.data, all->bytes, all->requests);
  }
  wait_for(all->requests);
  bytes = std::move(all->bytes);
  if (first()) bytes_sent_ += all->size * static_cast<std::uint64_t>(count() - 1);
}

std::unique_ptr<renderer::Ranks::AllGather> MpiCollectives::begin_gather(Bytes mine) {
  struct Running : AllGather {
    explicit Running(MpiCollectives& collectives) : mpi(collectives) {}
    std::vector<Bytes> wait() override {
      const WaitingTime time(mpi.waiting_);
      for (Pauses pauses;; pauses.sleep()) {
        const std::lock_guard lock(mpi_mutex());
        mpi.all_gathers_.advance();
        if (AllGathers::over(*gather)) break;
      }
      return AllGathers::take(*gather);
    }
    MpiCollectives& mpi;
    std::shared_ptr<AllGathers::Gather> gather;
  };
  if (is_single()) return renderer::OneRank().begin_gather(std::move(mine));
  auto running = std::make_unique<Running>(*this);
  bytes_sent_ += mine.size() * static_cast<std::uint64_t>(count() - 1);
  const std::lock_guard lock(mpi_mutex());
  running->gather = all_gathers_.begin(std::move(mine));
  return running;
}

renderer::Ranks::Traffic MpiCollectives::traffic() const {
  return {.bytes_sent = bytes_sent_, .waiting_seconds = 1e-9 * static_cast<double>(waiting_.load())};
}

}  // namespace gatelight::apps

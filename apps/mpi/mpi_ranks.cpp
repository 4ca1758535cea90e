#include "apps/mpi/mpi_ranks.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

#include "apps/mpi/all_gather.h"
#include "apps/mpi/chunks.h"
#include "apps/mpi/deadline.h"
#include "apps/mpi/mpi_calls.h"
#include "apps/mpi/mpi_world.h"
#include "apps/mpi/progress_thread.h"

namespace gatelight::apps {
namespace {

using renderer::Bytes;

/// Time limit for the start of all ranks, as a multiple of the silence after which a rank is lost.
constexpr double kStartTimes = 2.0;

/// Time limit for all-gathers after an error: one that some ranks have not begun cannot end.
constexpr std::chrono::seconds kAllGathersAfterError(2);

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

/// Returns a function that ends this process where other ranks do not answer; the launcher then ends those.
/// Other ranks wait longer than rank 0 (patience()), so that rank 0 prints the line.
std::function<void()> give_up(const RankCallbacks& callbacks, const std::string& line) {
  return [&callbacks, line] {
    callbacks.on_fault(callbacks.lost_code, line);
    std::_Exit(callbacks.lost_code);
  };
}

double patience(double seconds) {
  return seconds + std::min(rank_of_launcher(), 10);
}

}  // namespace

struct MpiRanks::Connection {
  Connection(int* argc, char*** argv) : world(argc, argv) {}
  bool gatherings_over() const {
    const std::lock_guard lock(mpi_mutex());
    return all_gathers.idle();
  }

  MpiWorld world;
  AllGathers all_gathers{world};
  std::optional<ProgressThread> progress_thread;  ///< empty for a single process
  Callbacks callbacks;
  std::optional<int> fault;  ///< exit code of the error
  bool ended = false;
  double silence = 0.0;
  int exceptions = std::uncaught_exceptions();
  std::atomic<std::uint64_t> bytes_sent = 0;
  std::atomic<std::int64_t> waiting = 0;  ///< nanoseconds
};

MpiRanks::MpiRanks(int* argc, char*** argv, Callbacks callbacks, double silence_seconds) {
  const double start_seconds = patience(kStartTimes * silence_seconds);
  {
    const Deadline deadline(
        start_seconds,
        give_up(callbacks, fmt::format("not all ranks have started within {:.0f} s", start_seconds)));
    connection_ = std::make_unique<Connection>(argc, argv);
  }
  Connection& mpi = *connection_;
  mpi.callbacks = std::move(callbacks);
  mpi.silence = silence_seconds;
  if (count() > 1) mpi.progress_thread.emplace(mpi.world, mpi.all_gathers, mpi.callbacks, silence_seconds);
}

MpiRanks::~MpiRanks() {
  Connection& mpi = *connection_;
  if (mpi.ended) return;
  // The others would wait forever.
  if (mpi.progress_thread && !mpi.fault && std::uncaught_exceptions() > mpi.exceptions)
    mpi.progress_thread->abort({.code = mpi.callbacks.lost_code, .line = "ended by an exception"});
  try {
    end();
  } catch (const std::exception& error) {
    if (mpi.progress_thread)
      mpi.progress_thread->abort({.code = mpi.callbacks.lost_code, .line = error.what()});
  }
}

int MpiRanks::rank() const {
  return connection_->world.rank;
}

int MpiRanks::count() const {
  return connection_->world.count;
}

int MpiRanks::local_count() const {
  return connection_->world.local_count;
}

const std::string& MpiRanks::host(int rank) const {
  return connection_->world.hosts.at(index(rank));
}

std::vector<Bytes> MpiRanks::exchange(std::vector<Bytes> outgoing) {
  Connection& mpi = *connection_;
  assert(outgoing.size() == index(count()));
  if (is_single()) return outgoing;
  const WaitingTime time(mpi.waiting);
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
    mpi.bytes_sent += bytes.size();
  }
  all->incoming_sizes.resize(index(count()));
  {
    const std::lock_guard lock(mpi_mutex());
    check(MPI_Ialltoall(all->outgoing_sizes.data(), 1, kUint64, all->incoming_sizes.data(), 1, kUint64,
                        mpi.world.data, all->requests.data()),
          "MPI_Ialltoall");
  }
  wait_for(all->requests);

  all->requests.clear();
  for (const std::uint64_t size : all->incoming_sizes) all->incoming.emplace_back(size);
  {
    const std::lock_guard lock(mpi_mutex());
    for (int other = 0; other < count(); ++other)
      begin_receive(mpi.world.data, other, all->incoming[index(other)], all->requests);
    // Each rank begins with the next rank, so that they do not all send to the same one.
    for (int i = 1; i < count(); ++i) {
      const int to = (rank() + i) % count();
      begin_send(mpi.world.data, to, all->outgoing[index(to)], all->requests);
    }
  }
  wait_for(all->requests);
  all->incoming[index(rank())] = std::move(own);
  return std::move(all->incoming);
}

void MpiRanks::broadcast(Bytes& bytes) {
  Connection& mpi = *connection_;
  if (is_single()) return;
  const WaitingTime time(mpi.waiting);
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
    begin_broadcast(mpi.world.data, std::as_writable_bytes(std::span(&all->size, 1)), all->requests);
  }
  wait_for(all->requests);

  all->requests.clear();
  all->bytes.resize(all->size);
  {
    const std::lock_guard lock(mpi_mutex());
    begin_broadcast(mpi.world.data, all->bytes, all->requests);
  }
  wait_for(all->requests);
  bytes = std::move(all->bytes);
  if (first()) mpi.bytes_sent += all->size * static_cast<std::uint64_t>(count() - 1);
}

std::unique_ptr<renderer::Ranks::AllGather> MpiRanks::begin_gather(Bytes mine) {
  struct Running : AllGather {
    explicit Running(Connection& connection) : mpi(connection) {}
    std::vector<Bytes> wait() override {
      const WaitingTime time(mpi.waiting);
      for (Pauses pauses;; pauses.sleep()) {
        const std::lock_guard lock(mpi_mutex());
        mpi.all_gathers.advance();
        if (AllGathers::over(*gather)) break;
      }
      return AllGathers::take(*gather);
    }
    Connection& mpi;
    std::shared_ptr<AllGathers::Gather> gather;
  };
  if (is_single()) return renderer::OneRank().begin_gather(std::move(mine));
  auto running = std::make_unique<Running>(*connection_);
  connection_->bytes_sent += mine.size() * static_cast<std::uint64_t>(count() - 1);
  const std::lock_guard lock(mpi_mutex());
  running->gather = connection_->all_gathers.begin(std::move(mine));
  return running;
}

renderer::Ranks::Traffic MpiRanks::traffic() const {
  return {.bytes_sent = connection_->bytes_sent,
          .waiting_seconds = 1e-9 * static_cast<double>(connection_->waiting.load())};
}

void MpiRanks::fail(int code, const std::string& line) {
  Connection& mpi = *connection_;
  mpi.fault = code;
  if (mpi.progress_thread) {
    mpi.progress_thread->fail({.code = code, .line = line});
  } else {
    mpi.callbacks.on_fault(code, line);
  }
}

void MpiRanks::end() {
  Connection& mpi = *connection_;
  if (mpi.ended) return;
  if (mpi.progress_thread) {
    const auto give_up = Clock::now() + kAllGathersAfterError;
    for (Pauses pauses; !mpi.gatherings_over(); pauses.sleep()) {
      if (mpi.fault && Clock::now() > give_up) abort_all(*mpi.fault);
    }
    Requests barrier{kNoRequest};
    {
      const std::lock_guard lock(mpi_mutex());
      check(MPI_Ibarrier(mpi.world.data, barrier.data()), "MPI_Ibarrier");
    }
    wait_for(barrier);
  }
  mpi.ended = true;
  const double seconds = patience(mpi.silence);
  const Deadline deadline(
      seconds, give_up(mpi.callbacks,
                       fmt::format("all is done, but some rank does not end within {:.0f} s", seconds)));
  if (mpi.progress_thread) mpi.progress_thread->stop();
  mpi.world.finalize();
}

}  // namespace gatelight::apps

#include "apps/mpi/mpi_ranks.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "apps/mpi/mpi_calls.h"
#include "apps/mpi/mpi_collectives.h"
#include "apps/mpi/mpi_world.h"
#include "apps/mpi/progress_thread.h"

namespace gatelight::apps {
namespace {

/// Time limit for the start of all ranks, as a multiple of the silence after which a rank is lost.
constexpr double kStartTimes = 2.0;

/// Time limit for all-gathers after an error: one that some ranks have not begun cannot end.
constexpr std::chrono::seconds kAllGathersAfterError(2);

/// A deadline for the MPI calls that wait for other ranks and cannot be polled: initialisation and
/// finalisation. Calls `late` on another thread after `seconds`, unless the object is destroyed before.
std::jthread deadline(double seconds, std::function<void()> late) {
  return std::jthread([seconds, late = std::move(late)](const std::stop_token& over) {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    const std::chrono::duration<double> time(seconds);
    if (!never.wait_for(lock, over, time, [&] { return over.stop_requested(); })) late();
  });
}

/// Rank of this process in the launcher's environment variables, which exist before MPI is initialised; 0
/// where there is none.
int rank_of_launcher() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK", "SLURM_PROCID"}) {
    if (const char* const rank = std::getenv(name)) return std::atoi(rank);
  }
  return 0;
}

/// Returns a function that ends this process where other ranks do not answer; the launcher then ends those.
/// Other ranks wait longer than rank 0 (start_timeout()), so that rank 0 prints the line.
std::function<void()> give_up(const RankCallbacks& callbacks, const std::string& line) {
  return [&callbacks, line] {
    callbacks.on_fault(callbacks.lost_code, line);
    std::_Exit(callbacks.lost_code);
  };
}

double start_timeout(double seconds) {
  return seconds + std::min(rank_of_launcher(), 10);
}

}  // namespace

struct MpiRanks::Connection {
  Connection(int* argc, char*** argv) : world(argc, argv) {}
  bool gatherings_over() {
    const std::lock_guard lock(mpi_mutex());
    return all.all_gathers().idle() && std::all_of(groups.begin(), groups.end(),
                                                   [](const auto& one) { return one->all_gathers().idle(); });
  }

  MpiWorld world;
  MpiCollectives all{world};
  std::vector<std::unique_ptr<MpiCollectives>> groups;  ///< that were split off
  std::optional<ProgressThread> progress_thread;        ///< empty for a single process
  Callbacks callbacks;
  std::optional<int> fault;  ///< exit code of the error
  bool ended = false;
  double silence = 0.0;
  int exceptions = std::uncaught_exceptions();
};

MpiRanks::MpiRanks(int* argc, char*** argv, Callbacks callbacks, double silence_seconds) {
  const double start_seconds = start_timeout(kStartTimes * silence_seconds);
  {
    const std::jthread started = deadline(
        start_seconds,
        give_up(callbacks, fmt::format("not all ranks have started within {:.0f} s", start_seconds)));
    connection_ = std::make_unique<Connection>(argc, argv);
  }
  Connection& mpi = *connection_;
  mpi.callbacks = std::move(callbacks);
  mpi.silence = silence_seconds;
  if (mpi.world.count > 1)
    mpi.progress_thread.emplace(mpi.world, mpi.all.all_gathers(), mpi.callbacks, silence_seconds);
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

renderer::Ranks& MpiRanks::all() {
  return connection_->all;
}

int MpiRanks::local_count() const {
  return connection_->world.local_count;
}

const std::vector<std::string>& MpiRanks::hosts() const {
  return connection_->world.hosts;
}

renderer::Ranks& MpiRanks::split(int group) {
  Connection& mpi = *connection_;
  auto part = std::make_unique<MpiCollectives>(mpi.world.split(group));
  const std::lock_guard lock(mpi_mutex());
  if (mpi.progress_thread) mpi.progress_thread->serve(part->all_gathers());
  return *mpi.groups.emplace_back(std::move(part));
}

void MpiRanks::stop_others(int signal) {
  if (connection_->progress_thread) connection_->progress_thread->stop_others(signal);
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
  const double seconds = start_timeout(mpi.silence);
  const std::jthread finished = deadline(
      seconds,
      give_up(mpi.callbacks,
              fmt::format("all work is done, but not all ranks have ended within {:.0f} s", seconds)));
  if (mpi.progress_thread) mpi.progress_thread->stop();
  std::vector<MpiGroup> groups;
  for (const auto& one : mpi.groups) groups.push_back(one->group());
  mpi.world.finalize(std::move(groups));
}

}  // namespace gatelight::apps

#include "apps/mpi/mpi_ranks.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "apps/mpi/failures.h"
#include "apps/mpi/mpi_calls.h"

namespace gatelight::apps {
namespace {

/// Time limit for the start of all ranks, as a multiple of the silence after which a rank is lost.
constexpr double kStartTimes = 2.0;

/// Time limit for exchanges after an error: one that some ranks have not begun cannot end.
constexpr std::chrono::seconds kExchangesAfterError(2);

/// A deadline for the MPI calls that wait for other ranks and cannot be polled: initialisation and
/// finalisation. After `seconds`, unless the object is destroyed before, another thread prints the line and
/// ends this process; the launcher then ends the others.
std::jthread deadline(double seconds, const std::string& line) {
  return std::jthread([seconds, line](const std::stop_token& over) {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    const std::chrono::duration<double> time(seconds);
    if (never.wait_for(lock, over, time, [&] { return over.stop_requested(); })) return;
    print_for_all({kLost, line, ""});
    std::_Exit(kLost);
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

/// Other ranks wait longer than rank 0, so that rank 0 prints the line.
double start_timeout(double seconds) {
  return seconds + std::min(rank_of_launcher(), 10);
}

MpiWorld start(int* argc, char*** argv, double silence) {
  const double seconds = start_timeout(kStartTimes * silence);
  const std::jthread started =
      deadline(seconds, fmt::format("not all ranks have started within {:.0f} s", seconds));
  return {argc, argv};
}

}  // namespace

MpiRanks::MpiRanks(int* argc, char*** argv, double silence_seconds)
    : silence_(silence_seconds), world_(start(argc, argv, silence_seconds)) {
  if (world_.count > 1) progress_thread_.emplace(world_, all_.exchanges(), silence_seconds);
}

MpiRanks::~MpiRanks() {
  if (ended_) return;
  // The others would wait forever.
  if (progress_thread_ && !fault_ && std::uncaught_exceptions() > exceptions_)
    progress_thread_->abort({kLost, "ended by an exception", ""});
  try {
    end();
  } catch (const std::exception& error) {
    if (progress_thread_) progress_thread_->abort({kLost, error.what(), ""});
  }
}

MpiCollectives& MpiRanks::split(int group) {
  auto part = std::make_unique<MpiCollectives>(world_.split(group));
  const std::lock_guard lock(mpi_mutex());
  progress_thread_->serve(part->exchanges());
  return *groups_.emplace_back(std::move(part));
}

void MpiRanks::fail(const Failure& failure) {
  fault_ = failure.code;
  progress_thread_->fail(failure);
}

bool MpiRanks::exchanges_over() {
  const std::lock_guard lock(mpi_mutex());
  return all_.exchanges().idle() &&
         std::all_of(groups_.begin(), groups_.end(), [](const auto& one) { return one->exchanges().idle(); });
}

void MpiRanks::end() {
  if (ended_) return;
  if (progress_thread_) {
    const auto give_up = Clock::now() + kExchangesAfterError;
    for (Pauses pauses; !exchanges_over(); pauses.sleep()) {
      if (fault_ && Clock::now() > give_up) abort_all(*fault_);
    }
    Requests barrier{kNoRequest};
    {
      const std::lock_guard lock(mpi_mutex());
      check(MPI_Ibarrier(world_.data, barrier.data()), "MPI_Ibarrier");
    }
    wait_for(barrier);
  }
  ended_ = true;
  const double seconds = start_timeout(silence_);
  const std::jthread finished = deadline(
      seconds, fmt::format("all work is done, but not all ranks have ended within {:.0f} s", seconds));
  if (progress_thread_) progress_thread_->stop();
  std::vector<MpiGroup> groups;
  for (const auto& one : groups_) groups.push_back(one->group());
  world_.finalize(std::move(groups));
}

}  // namespace gatelight::apps

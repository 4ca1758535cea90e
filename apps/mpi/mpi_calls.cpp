#include "apps/mpi/mpi_calls.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include "base/errors.h"

namespace gatelight::apps {
namespace {

constexpr double kLongestPause = 1000.0;  // microseconds

std::atomic<int> waiting{0};
std::atomic<int> abort_code{0};

}  // namespace

std::timed_mutex& mpi_mutex() {
  static std::timed_mutex mutex;
  return mutex;
}

void check(int result, const char* function) {
  if (result == MPI_SUCCESS) return;
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  if (MPI_Error_string(result, text.data(), &length) != MPI_SUCCESS) length = 0;
  throw MpiError(
      fmt::format("{} failed: {}", function, std::string(text.data(), static_cast<std::size_t>(length))));
}

bool all_done(Requests& requests) {
  int done = 0;
  check(MPI_Testall(static_cast<int>(requests.size()), requests.data(), &done, kNoStatuses), "MPI_Testall");
  return done != 0;
}

void wait_for(Requests& requests) {
  for (Pauses pauses;; pauses.sleep()) {
    const std::lock_guard lock(mpi_mutex());
    if (all_done(requests)) return;
  }
}

Pauses::Pauses() {
  ++waiting;
}

Pauses::~Pauses() {
  --waiting;
}

void Pauses::sleep() {
  std::this_thread::sleep_for(std::chrono::duration<double, std::micro>(microseconds_));
  microseconds_ = std::min(1.2 * microseconds_, kLongestPause);
}

bool any_waiting() {
  return waiting > 0;
}

void abort_all(int code) {
  abort_code = code;
  // MPI_Abort may call exit(), whose destructors would meet threads that still compute.
  std::atexit([] { std::_Exit(abort_code); });
  const std::unique_lock lock(mpi_mutex(), std::chrono::seconds(2));
  // Where a call of another thread hangs, the exit code shows the launcher that the job failed.
  if (lock) MPI_Abort(kWorld, code);
  std::_Exit(code);
}

}  // namespace gatelight::apps

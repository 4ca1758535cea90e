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
constexpr std::size_t kChunk = std::size_t{512} << 20;
constexpr int kTag = 0;

std::atomic<int> waiting{0};
std::atomic<int> abort_code{0};

/// Calls begin(data, length, request) for each chunk.
template <class Byte, class Begin>
void each_chunk(std::span<Byte> bytes, Requests& requests, const Begin& begin) {
  while (!bytes.empty()) {
    const std::span<Byte> chunk = bytes.first(std::min(kChunk, bytes.size()));
    begin(chunk.data(), static_cast<int>(chunk.size()), &requests.emplace_back(kNoRequest));
    bytes = bytes.subspan(chunk.size());
  }
}

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

void begin_send(MPI_Comm comm, int to, std::span<const std::byte> bytes, Requests& requests) {
  each_chunk(bytes, requests, [&](const std::byte* data, int length, MPI_Request* request) {
    check(MPI_Isend(data, length, kByte, to, kTag, comm, request), "MPI_Isend");
  });
}

void begin_receive(MPI_Comm comm, int from, std::span<std::byte> bytes, Requests& requests) {
  each_chunk(bytes, requests, [&](std::byte* data, int length, MPI_Request* request) {
    check(MPI_Irecv(data, length, kByte, from, kTag, comm, request), "MPI_Irecv");
  });
}

void begin_broadcast(MPI_Comm comm, std::span<std::byte> bytes, Requests& requests) {
  each_chunk(bytes, requests, [&](std::byte* data, int length, MPI_Request* request) {
    check(MPI_Ibcast(data, length, kByte, 0, comm, request), "MPI_Ibcast");
  });
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

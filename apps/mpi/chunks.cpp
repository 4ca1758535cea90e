#include "apps/mpi/chunks.h"

#include <algorithm>

namespace gatelight::apps {
namespace {

constexpr std::size_t kChunk = std::size_t{512} << 20;
constexpr int kTag = 0;

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

}  // namespace gatelight::apps

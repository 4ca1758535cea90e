#pragma once
// Messages of any length by MPI, whose lengths are ints. The caller holds the mutex, and keeps the bytes
// until the requests are done.

#include <cstddef>
#include <span>

#include "apps/mpi/mpi_calls.h"

namespace gatelight::apps {

/// Both sides know the length. Nothing is sent where it is 0.
void begin_send(MPI_Comm comm, int to, std::span<const std::byte> bytes, Requests& requests);
void begin_receive(MPI_Comm comm, int from, std::span<std::byte> bytes, Requests& requests);

/// Broadcasts the bytes of rank 0.
void begin_broadcast(MPI_Comm comm, std::span<std::byte> bytes, Requests& requests);

}  // namespace gatelight::apps

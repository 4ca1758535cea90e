#pragma once
// MPI is called by one thread at a time, and only by non-blocking calls. MPI's own waiting keeps a core busy,
// which another rank may need.

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#include <mpi.h>

#include <cstddef>
#include <exception>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace gatelight::apps {

// MPI's constants are macros with old casts.
inline const MPI_Comm kWorld = MPI_COMM_WORLD;
inline const MPI_Comm kNoComm = MPI_COMM_NULL;
inline const MPI_Errhandler kReturnErrors = MPI_ERRORS_RETURN;
inline const MPI_Datatype kByte = MPI_BYTE;
inline const MPI_Datatype kUint64 = MPI_UINT64_T;
inline const MPI_Request kNoRequest = MPI_REQUEST_NULL;
inline MPI_Status* const kNoStatus = MPI_STATUS_IGNORE;
inline MPI_Status* const kNoStatuses = MPI_STATUSES_IGNORE;
#pragma GCC diagnostic pop

using Requests = std::vector<MPI_Request>;

/// The mutex that a thread holds while it calls MPI.
std::timed_mutex& mpi_mutex();

/// Throws MpiError where an MPI function failed.
void check(int result, const char* function);

/// Whether all requests are complete. The caller holds the mutex.
bool all_done(Requests& requests);

/// Waits for all requests. The caller does not hold the mutex.
void wait_for(Requests& requests);

// Messages of any length, in pieces: MPI's lengths are ints. The caller holds the mutex, and keeps the bytes
// until the requests are done.
/// Both sides know the length. Nothing is sent where it is 0.
void begin_send(MPI_Comm comm, int to, std::span<const std::byte> bytes, Requests& requests);
void begin_receive(MPI_Comm comm, int from, std::span<std::byte> bytes, Requests& requests);

/// Broadcasts the bytes of rank 0.
void begin_broadcast(MPI_Comm comm, std::span<std::byte> bytes, Requests& requests);

/// Sleeps between the polls of a thread that waits: short at first, then longer.
class Pauses {
 public:
  Pauses();
  ~Pauses();
  Pauses(const Pauses&) = delete;
  Pauses& operator=(const Pauses&) = delete;
  void sleep();

 private:
  double microseconds_ = 100.0;
};

/// Whether a thread waits with Pauses.
bool any_waiting();

/// Ends all ranks.
[[noreturn]] void abort_all(int code);

/// Memory that MPI reads or writes after a call returned. It is not freed where an exception leaves the
/// scope, because MPI may still use it.
template <class T>
class MpiMemory {
 public:
  MpiMemory() = default;
  ~MpiMemory() {
    if (std::uncaught_exceptions() == exceptions_) delete value_;
  }
  MpiMemory(const MpiMemory&) = delete;
  MpiMemory& operator=(const MpiMemory&) = delete;
  T* operator->() const { return value_; }
  T& operator*() const { return *value_; }

 private:
  T* value_ = new T();
  int exceptions_ = std::uncaught_exceptions();
};

}  // namespace gatelight::apps

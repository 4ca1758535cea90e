#pragma once
// MPI's initialisation and finalisation, and the ranks and hosts of all processes.

#include <string>
#include <vector>

#include "apps/mpi/mpi_calls.h"

namespace gatelight::apps {

/// Collectives of one communicator must be called in the same order on all ranks, so collectives that run at
/// the same time have separate communicators.
struct MpiWorld {
  /// All processes call it. Throws MpiError where this MPI cannot be used by several threads.
  MpiWorld(int* argc, char*** argv);
  /// All processes call it, and none of them calls MPI afterwards.
  void finalize();

  int rank = 0;
  int count = 1;
  int local_count = 1;             ///< processes of this machine
  std::vector<std::string> hosts;  ///< of each rank
  MPI_Comm data = kNoComm;         ///< exchanges and broadcasts
  MPI_Comm all_gathers = kNoComm;
  MPI_Comm messages = kNoComm;  ///< heartbeats and errors
};

/// "rank 3 of 5 (host)"
std::string name_of(const MpiWorld& world, int rank);

}  // namespace gatelight::apps

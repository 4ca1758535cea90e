#pragma once
// MPI's initialisation and finalisation, and the ranks and hosts of all processes or of a group of them.

#include <string>
#include <vector>

#include "apps/mpi/mpi_calls.h"

namespace gatelight::apps {

/// Collectives of one communicator must be called in the same order on all its ranks, so collectives that run
/// at the same time have separate communicators.
struct MpiGroup {
  int rank = 0;
  int count = 1;
  MPI_Comm data = kNoComm;  ///< broadcasts
  MPI_Comm exchanges = kNoComm;
  std::vector<std::string> hosts;  ///< of each rank

  /// "rank 3 of 5 (host)"
  std::string name_of(int number) const;
};

struct MpiWorld : MpiGroup {
  /// All processes call it. Throws MpiError where this MPI cannot be used by several threads.
  MpiWorld(int* argc, char*** argv);
  /// All processes call it, and none of them calls MPI afterwards. `groups`: those that were split off.
  void finalize(std::vector<MpiGroup> groups);

  /// The ranks that name the same group, in their order. All processes call it at about the same time: it
  /// waits for them without heartbeats.
  MpiGroup split(int group) const;

  MPI_Comm messages = kNoComm;  ///< heartbeats and errors
};

}  // namespace gatelight::apps

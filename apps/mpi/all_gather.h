#pragma once
// All-gathers that progress while the ranks compute: a thread calls advance() regularly.

#include <deque>
#include <memory>
#include <vector>

#include "apps/mpi/mpi_world.h"
#include "renderer/distributed/ranks.h"

namespace gatelight::apps {

/// The caller holds the mutex.
class AllGathers {
 public:
  explicit AllGathers(const MpiGroup& group) : group_(group) {}

  class Gather;
  /// Returns at once. All-gathers run one after the other.
  std::shared_ptr<Gather> begin(renderer::Bytes mine);
  void advance();
  bool idle() const { return waiting_.empty(); }

  /// Whether the all-gather has ended, with or without success.
  static bool over(const Gather& gather);
  /// Returns the bytes in the order of ranks. Throws the exception that made the all-gather fail.
  static std::vector<renderer::Bytes> take(Gather& gather);

 private:
  const MpiGroup& group_;
  std::deque<std::shared_ptr<Gather>> waiting_;  ///< the first one runs
  std::vector<std::shared_ptr<Gather>> failed_;  ///< kept, because MPI may still use their memory
};

}  // namespace gatelight::apps

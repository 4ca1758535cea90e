#pragma once
// Gatherings that go on while the ranks compute: someone calls advance() now and then.

#include <deque>
#include <memory>
#include <vector>

#include "apps/mpi/mpi_world.h"
#include "renderer/ranks/ranks.h"

namespace gatelight::apps {

/// The caller holds the mutex.
class Gatherings {
 public:
  explicit Gatherings(const MpiWorld& world) : world_(world) {}

  class Gather;
  /// Returns at once. They run one after the other.
  std::shared_ptr<Gather> begin(renderer::Bytes mine);
  void advance();
  bool idle() const { return waiting_.empty(); }

  /// Whether it is over, with or without success.
  static bool over(const Gather& gather);
  /// Its bytes in the order of ranks. Throws what made it fail.
  static std::vector<renderer::Bytes> take(Gather& gather);

 private:
  const MpiWorld& world_;
  std::deque<std::shared_ptr<Gather>> waiting_;  ///< the first one runs
  std::vector<std::shared_ptr<Gather>> failed_;  ///< kept, because MPI may still use their memory
};

}  // namespace gatelight::apps

#pragma once
// Exchanges and broadcasts of all ranks or of a group of them.

#include <memory>
#include <vector>

#include "apps/mpi/exchanges.h"
#include "apps/mpi/mpi_world.h"
#include "renderer/distributed/ranks.h"

namespace gatelight::apps {

class MpiCollectives final : public renderer::Ranks {
 public:
  explicit MpiCollectives(const MpiGroup& group) : group_(group), exchanges_(group_) {}

  int rank() const override { return group_.rank; }
  int count() const override { return group_.count; }
  void broadcast(renderer::Bytes& bytes) override;
  std::unique_ptr<renderer::Ranks::Exchange> begin_exchange(std::vector<renderer::Bytes> outgoing) override;
  renderer::Traffic traffic() const override { return traffic_; }

  const MpiGroup& group() const { return group_; }
  Exchanges& exchanges() { return exchanges_; }

 private:
  MpiGroup group_;
  Exchanges exchanges_;
  renderer::Traffic traffic_;
};

}  // namespace gatelight::apps

#pragma once
// Exchanges, broadcasts and all-gathers of all ranks or of a group of them.

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "apps/mpi/all_gather.h"
#include "apps/mpi/mpi_world.h"
#include "renderer/distributed/ranks.h"

namespace gatelight::apps {

class MpiCollectives final : public renderer::Ranks {
 public:
  explicit MpiCollectives(const MpiGroup& group) : group_(group), all_gathers_(group_) {}

  int rank() const override { return group_.rank; }
  int count() const override { return group_.count; }
  std::vector<renderer::Bytes> exchange(std::vector<renderer::Bytes> outgoing) override;
  void broadcast(renderer::Bytes& bytes) override;
  std::unique_ptr<AllGather> begin_gather(renderer::Bytes mine) override;
  Traffic traffic() const override;

  const MpiGroup& group() const { return group_; }
  AllGathers& all_gathers() { return all_gathers_; }

 private:
  MpiGroup group_;
  AllGathers all_gathers_;
  std::atomic<std::uint64_t> bytes_sent_ = 0;
  std::atomic<std::int64_t> waiting_ = 0;  ///< nanoseconds
};

}  // namespace gatelight::apps

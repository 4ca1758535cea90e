#include "renderer/distributed/ranks.h"

#include <utility>

namespace gatelight::renderer {

std::unique_ptr<Ranks::AllGather> OneRank::begin_gather(Bytes mine) {
  struct Done : AllGather {
    std::vector<Bytes> all;
    std::vector<Bytes> wait() override { return std::move(all); }
  };
  auto done = std::make_unique<Done>();
  done->all.push_back(std::move(mine));
  return done;
}

Ranks& one_rank() {
  static OneRank rank;  // it has no state
  return rank;
}

}  // namespace gatelight::renderer

#pragma once
// Prefetches memory at the pace of the arithmetic. Part of kernel_table.cpp.

#include "base/simd/vectors.h"
#include "neural/cpu/kernels.h"

namespace {

using namespace gatelight::neural::cpu;

/// Prefetches into the L1 cache, for data that is read soon.
GATELIGHT_INLINE void prefetch(const void* p) {
  __builtin_prefetch(p, 0, 3);
}
/// Prefetches into the L2 cache, for data that is read after a tile's arithmetic.
GATELIGHT_INLINE void prefetch_far(const void* p) {
  __builtin_prefetch(p, 0, 2);
}

// Prefetches the feature vectors of a tile, a few at a time between blocks of arithmetic, so that cache
// misses overlap with it.
struct Prefetcher {
  const uint32_t* nodes = nullptr;
  uint32_t count = 0;
  uint32_t next = 0;
  uint32_t step = 0;
  const char* base = nullptr;
  uint32_t bytes = 0;

  __attribute__((always_inline)) void some() {
    const uint32_t end = next + step < count ? next + step : count;
    for (; next < end; ++next) prefetch_far(base + uint64_t{nodes[next]} * bytes);
  }
  __attribute__((always_inline)) void rest() {
    for (; next < count; ++next) prefetch_far(base + uint64_t{nodes[next]} * bytes);
  }
};

GATELIGHT_INLINE Prefetcher make_prefetcher(const KernelEncoder& e, const uint32_t* nodes, uint32_t blocks) {
  Prefetcher p;
  p.nodes = nodes;
  p.count = e.levels * e.nodes_per_level * kTile;
  p.step = (p.count + blocks - 1) / blocks;
  p.base = e.half_features != nullptr ? reinterpret_cast<const char*>(e.half_features)
                                      : reinterpret_cast<const char*>(e.float_features);
  p.bytes = e.feature_stride * (e.half_features != nullptr ? 2 : 4);
  return p;
}

// The products call this after each block.
struct Between {
  Prefetcher* prefetcher;
  __attribute__((always_inline)) void operator()() const { prefetcher->some(); }
};

}  // namespace

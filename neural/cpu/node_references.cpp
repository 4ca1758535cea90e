#include "neural/cpu/node_references.h"

#include <bit>

namespace gatelight::neural::cpu {

Buckets make_buckets(std::uint32_t nodes, std::uint32_t references) {
  constexpr std::uint32_t kFewest = 128, kMax = 512, kMinShift = 4;
  const std::uint32_t wanted = std::clamp(std::bit_floor(references / 2), kFewest, kMax);
  Buckets b;
  b.nodes = nodes;
  b.shift = std::max(kMinShift, static_cast<std::uint32_t>(std::bit_width(nodes / wanted)));
  b.count = nodes == 0 ? 0 : ((nodes - 1) >> b.shift) + 1;
  return b;
}

void NodeReferences::start(const Chunks& chunks, const Buckets& buckets, std::uint32_t slots) {
  chunks_ = chunks;
  buckets_ = buckets;
  slots_ = slots;
  const std::size_t references = std::size_t{chunks.tiles()} * slots * kTile;
  reserve(nodes_, references);
  reserve(weights_, references);
  reserve(references_, references);
  // Whole lines, an odd number of them: the same bucket of all chunks is not in one set of the cache.
  stride_ = (buckets.count + 1 + 31) / 32 * 32 + 16;
  reserve(starts_, std::size_t{chunks.count} * stride_);
}

void NodeReferences::sort(std::uint32_t chunk, std::uint32_t nodes_per_level, std::uint32_t features,
                          std::uint32_t feature_inputs) {
  if (buckets_.count == 0) return;
  const std::uint32_t shift = buckets_.shift, begin = chunks_.begin(chunk), end = chunks_.end(chunk);
  const std::uint32_t* const nodes = nodes_.data() + std::size_t{begin} * slots_;
  const float* const weights = weights_.data() + std::size_t{begin} * slots_;
  // Slots behind the last record have weight 0.
  const std::size_t count = std::size_t{(end - begin + kTile - 1) / kTile} * kTile * slots_;

  // next[b] counts bucket b - 1, then is where its next reference goes, and at last where bucket b ends.
  std::uint32_t* const next = starts(chunk);
  std::fill_n(next, buckets_.count + 1, 0u);
  for (std::size_t i = 0; i < count; ++i) next[(nodes[i] >> shift) + 1] += weights[i] != 0.0f ? 1u : 0u;
  std::uint32_t total = 0;
  for (std::uint32_t b = 0; b <= buckets_.count; ++b) {
    total += next[b];
    next[b] = total;
  }
  KernelReference* const to = references(chunk);
  for (std::uint32_t first = begin; first < end; first += kTile) {
    const std::size_t tile = std::size_t{first - begin} * slots_;
    for (std::uint32_t slot = 0; slot < slots_; ++slot) {
      const std::uint32_t level = slot / nodes_per_level * features;
      for (std::uint32_t s = 0; s < kTile; ++s) {
        const std::size_t i = tile + slot * kTile + s;
        if (weights[i] == 0.0f) continue;
        to[next[nodes[i] >> shift]++] = {nodes[i], (first + s) * feature_inputs + level, weights[i]};
      }
    }
  }
  for (std::uint32_t b = buckets_.count; b > 0; --b) next[b] = next[b - 1];
  next[0] = 0;
}

void NodeReferences::prefetch(std::uint32_t bucket) const {
  constexpr std::uint32_t kOfLine = 64 / sizeof(KernelReference);
  for (std::uint32_t chunk = 0; chunk < chunks_.count; ++chunk) {
    const std::uint32_t* const at = starts(chunk) + bucket;
    for (std::uint32_t i = at[0]; i < at[1]; i += kOfLine) __builtin_prefetch(references(chunk) + i);
  }
}

std::uint32_t NodeReferences::size(std::uint32_t bucket) const {
  std::uint32_t sum = 0;
  for (std::uint32_t chunk = 0; chunk < chunks_.count; ++chunk) {
    const std::uint32_t* const at = starts(chunk) + bucket;
    sum += at[1] - at[0];
  }
  return sum;
}

void NodeReferences::copy(std::uint32_t bucket, KernelReference* to) const {
  for (std::uint32_t chunk = 0; chunk < chunks_.count; ++chunk) {
    const std::uint32_t* const at = starts(chunk) + bucket;
    to = std::copy(references(chunk) + at[0], references(chunk) + at[1], to);
  }
}

}  // namespace gatelight::neural::cpu

#include "neural/cpu/node_references.h"

#include <algorithm>
#include <bit>

#include "base/parallel/loops.h"
#include "base/platform/flush_denormals.h"

namespace gatelight::neural::cpu {

Buckets make_buckets(std::uint32_t nodes) {
  constexpr std::uint32_t kBuckets = 1024, kLeastShift = 4;
  Buckets b;
  b.nodes = nodes;
  b.shift = std::max(kLeastShift, static_cast<std::uint32_t>(std::bit_width(nodes / kBuckets)));
  b.count = nodes == 0 ? 0 : ((nodes - 1) >> b.shift) + 1;
  return b;
}

void NodeReferences::start(const Chunks& chunks, const Buckets& buckets, std::uint32_t slots) {
  chunks_ = chunks;
  buckets_ = buckets;
  slots_ = slots;
  const std::size_t tiles = (std::size_t{chunks.records} + kTile - 1) / kTile;
  reserve(nodes_, tiles * slots * kTile);
  reserve(weights_, tiles * slots * kTile);
  reserve(references_, tiles * slots * kTile);
  counts_.assign(std::size_t{chunks.count()} * buckets.count, 0);
  starts_.assign(buckets.count + 1, 0);
}

void NodeReferences::sort(std::uint32_t nodes_per_level, std::uint32_t features,
                          std::uint32_t feature_inputs) {
  if (buckets_.count == 0) return;
  // Turn counts into the offsets at which each chunk writes into each bucket.
  std::uint32_t total = 0;
  for (std::uint32_t b = 0; b < buckets_.count; ++b) {
    starts_[b] = total;
    for (std::uint32_t c = 0; c < chunks_.count(); ++c) {
      std::uint32_t& count = counts_[std::size_t{c} * buckets_.count + b];
      const std::uint32_t here = count;
      count = total;
      total += here;
    }
  }
  starts_[buckets_.count] = total;

  for_each(chunks_.count(), [&](std::size_t number) {
    const auto chunk = static_cast<std::uint32_t>(number);
    // As in the count, a denormal weight counts as zero.
    const FlushDenormals flush;
    std::uint32_t* const next = counts(chunk);
    KernelReference* const references = references_.data();
    const std::uint32_t slots = slots_, shift = buckets_.shift;
    for (std::uint32_t first = chunks_.begin(chunk); first < chunks_.end(chunk); first += kTile) {
      const std::uint32_t* nodes = nodes_.data() + std::size_t{first} * slots;
      const float* weights = weights_.data() + std::size_t{first} * slots;
      const std::uint32_t count = std::min(kTile, chunks_.end(chunk) - first);
      for (std::uint32_t s = 0; s < count; ++s) {
        std::uint32_t source = (first + s) * feature_inputs;
        for (std::uint32_t slot = 0; slot < slots; source += features)
          for (std::uint32_t n = 0; n < nodes_per_level; ++n, ++slot) {
            const float weight = weights[slot * kTile + s];
            if (weight == 0.0f) continue;
            const std::uint32_t node = nodes[slot * kTile + s];
            references[next[node >> shift]++] = {node, source, weight};
          }
      }
    }
  });
}

}  // namespace gatelight::neural::cpu

#pragma once
// References from records to nodes, sorted by buckets of neighbouring nodes with a stable counting sort.
// Within a bucket they have the order of the records, so sums over a bucket do not depend on the number of
// threads.

#include <cstdint>
#include <vector>

#include "neural/cpu/huge_buffer.h"
#include "neural/cpu/kernels.h"

namespace gatelight::neural::cpu {

/// A batch is cut into chunks of whole tiles, depending only on its size.
struct Chunks {
  static constexpr std::uint32_t kRecords = 16 * kTile;

  std::uint32_t records = 0;

  std::uint32_t count() const { return (records + kRecords - 1) / kRecords; }
  std::uint32_t begin(std::uint32_t chunk) const { return chunk * kRecords; }
  std::uint32_t end(std::uint32_t chunk) const {
    return records - begin(chunk) < kRecords ? records : begin(chunk) + kRecords;
  }
};

/// A bucket holds 2^shift nodes. There are about a thousand buckets, so that threads share them evenly and a
/// bucket's sums stay in the L2 cache.
struct Buckets {
  std::uint32_t shift = 0;
  std::uint32_t count = 0;
  std::uint32_t nodes = 0;

  std::uint32_t first(std::uint32_t bucket) const { return bucket << shift; }
  std::uint32_t size(std::uint32_t bucket) const {
    return nodes - first(bucket) < (1u << shift) ? nodes - first(bucket) : 1u << shift;
  }
};
Buckets make_buckets(std::uint32_t nodes);

class NodeReferences {
 public:
  /// Prepares for a batch and sets the counts of all chunks to zero.
  void start(const Chunks& chunks, const Buckets& buckets, std::uint32_t slots);

  // The kernels fill these arrays.
  std::uint32_t* nodes() const { return nodes_.data(); }
  float* weights() const { return weights_.data(); }
  std::uint32_t* counts(std::uint32_t chunk) { return counts_.data() + std::size_t{chunk} * buckets_.count; }

  /// Sorts the references that the kernels wrote. KernelReference::source is record * feature_inputs + level
  /// * features.
  void sort(std::uint32_t nodes_per_level, std::uint32_t features, std::uint32_t feature_inputs);

  const KernelReference* begin(std::uint32_t bucket) const { return references_.data() + starts_[bucket]; }
  std::uint32_t size(std::uint32_t bucket) const { return starts_[bucket + 1] - starts_[bucket]; }

 private:
  Chunks chunks_;
  Buckets buckets_;
  std::uint32_t slots_ = 0;
  HugeBuffer<std::uint32_t> nodes_;
  HugeBuffer<float> weights_;
  HugeBuffer<KernelReference> references_;
  std::vector<std::uint32_t> counts_;  // [chunk][bucket]
  std::vector<std::uint32_t> starts_;  // [bucket]
};

}  // namespace gatelight::neural::cpu

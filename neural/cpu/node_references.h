#pragma once
// References from records to nodes. Each chunk of records sorts its own by buckets of neighbouring nodes, so
// no step of the sort waits for another chunk. A bucket's references are then those of all chunks in their
// order, so sums over a node do not depend on the number of threads.

#include <algorithm>
#include <cstdint>

#include "base/platform/huge_buffer.h"
#include "neural/cpu/kernels.h"

namespace gatelight::neural::cpu {

/// A batch is cut into chunks of whole tiles, depending only on its size: at most 64, because the network's
/// gradients are summed for each.
struct Chunks {
  static constexpr std::uint32_t kMax = 64;

  explicit Chunks(std::uint32_t batch_records = 0) : records(batch_records) {
    const std::uint32_t all = tiles();
    tiles_of_chunk = std::max((all + kMax - 1) / kMax, 1u);
    count = (all + tiles_of_chunk - 1) / tiles_of_chunk;
  }
  std::uint32_t tiles() const { return records / kTile + (records % kTile > 0 ? 1 : 0); }
  std::uint32_t begin(std::uint32_t chunk) const { return chunk * tiles_of_chunk * kTile; }
  std::uint32_t end(std::uint32_t chunk) const { return std::min(begin(chunk + 1), records); }

  std::uint32_t records = 0;
  std::uint32_t tiles_of_chunk = 1;
  std::uint32_t count = 0;
};

/// A bucket holds 2^shift nodes. A bucket's sums should stay in the L2 cache, and a chunk should have some
/// references for each.
struct Buckets {
  std::uint32_t shift = 0;
  std::uint32_t count = 0;
  std::uint32_t nodes = 0;

  std::uint32_t first(std::uint32_t bucket) const { return bucket << shift; }
  std::uint32_t size(std::uint32_t bucket) const {
    return nodes - first(bucket) < (1u << shift) ? nodes - first(bucket) : 1u << shift;
  }
};
/// For chunks of so many references.
Buckets make_buckets(std::uint32_t nodes, std::uint32_t references);

class NodeReferences {
 public:
  /// Prepares for a batch whose records have `slots` references each.
  void start(const Chunks& chunks, const Buckets& buckets, std::uint32_t slots);

  // The kernels fill these arrays.
  std::uint32_t* nodes() const { return nodes_.data(); }
  float* weights() const { return weights_.data(); }

  /// Sorts the references of a chunk that the kernels wrote. KernelReference::source is record *
  /// feature_inputs + level * features. Chunks may be sorted at the same time.
  void sort(std::uint32_t chunk, std::uint32_t nodes_per_level, std::uint32_t features,
            std::uint32_t feature_inputs);

  // When all chunks are sorted:
  /// Fetches the references to a bucket into the cache: each chunk's lie elsewhere.
  void prefetch(std::uint32_t bucket) const;
  /// The number of references to a bucket.
  std::uint32_t size(std::uint32_t bucket) const;
  /// Copies them to `to`.
  void copy(std::uint32_t bucket, KernelReference* to) const;

 private:
  /// The references of a chunk to each bucket begin there, among those of the chunk.
  std::uint32_t* starts(std::uint32_t chunk) const { return starts_.data() + std::size_t{chunk} * stride_; }
  KernelReference* references(std::uint32_t chunk) const {
    return references_.data() + std::size_t{chunks_.begin(chunk)} * slots_;
  }

  Chunks chunks_;
  Buckets buckets_;
  std::uint32_t slots_ = 0;
  std::uint32_t stride_ = 0;  ///< of the starts of a chunk
  HugeBuffer<std::uint32_t> nodes_;
  HugeBuffer<float> weights_;
  HugeBuffer<KernelReference> references_;
  HugeBuffer<std::uint32_t> starts_;
};

}  // namespace gatelight::neural::cpu

#pragma once
// The division of a step's work, and its arrays besides the batch and the state.

#include <array>

#include "neural/vulkan/blocks.h"
#include "neural/vulkan/buffer.h"

namespace gatelight::neural::vulkan {

/// Records that a workgroup of train_network holds in shared memory: the largest power of two that fits, at
/// most 64.
std::uint32_t training_tile(const Model& model, std::uint32_t shared_bytes);

/// The division of a step. It depends only on the batch's size, the model and the tile, so that sums have one
/// order.
struct StepCut {
  std::uint32_t size = 0, references = 0, tiles = 0, groups = 0;
};
StepCut cut_step(const Model& model, std::uint64_t records, std::uint32_t tile);

/// The maximum number of records for which each array fits `longest_buffer` bytes.
std::uint64_t most_records(const Model& model, std::uint64_t longest_buffer);

class StepScratch {
 public:
  /// Allocates for batches of this many records; growing loses the contents.
  void reserve(const Device& device, const Model& model, std::uint64_t records, std::uint32_t tile);
  std::uint64_t capacity() const { return block_.capacity; }
  /// The addresses of the arrays and the capacity.
  const BatchBlock& block() const { return block_; }

 private:
  BatchBlock block_;
  std::array<Buffer, 13> buffers_;
};

}  // namespace gatelight::neural::vulkan

#pragma once
// A batch's spans behind one another, after the block that says where: what one copy brings to the device.

#include "neural/base/batch.h"
#include "neural/vulkan/blocks.h"

namespace gatelight::neural::vulkan {

/// Bytes for so many points, with targets or without.
std::uint64_t upload_bytes(const Model& model, std::uint64_t points, bool targets);

/// Points [begin, begin + block.size) of the batch, and their targets where there are any. `address` is where
/// `to` will lie on the device; block.surfaces to block.targets are set, then the block is written too.
void write_upload(const Model& model, const QueryBatch& points, std::span<const float> targets,
                  std::uint64_t begin, Address address, BatchBlock& block, std::byte* to);

}  // namespace gatelight::neural::vulkan

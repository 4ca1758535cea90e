#pragma once
// Packs a batch for one copy to the device: its block, followed by its spans.

#include "neural/model/batch.h"
#include "neural/vulkan/blocks.h"

namespace gatelight::neural::vulkan {

/// Bytes for this many points, with or without targets.
std::uint64_t upload_bytes(const Model& model, std::uint64_t points, bool targets);

/// Writes points [begin, begin + block.size) of the batch, and their targets if there are any, to `to`.
/// `address` is the later address of `to` on the device. Sets block.surfaces to block.targets and writes the
/// block, too.
void write_upload(const Model& model, const QueryBatch& points, std::span<const float> targets,
                  std::uint64_t begin, Address address, BatchBlock& block, std::byte* to);

}  // namespace gatelight::neural::vulkan

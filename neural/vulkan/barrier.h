#pragma once
// Barriers and fences. One global barrier serves the whole backend: on a queue with only compute and copies,
// a finer barrier would order the same work.

#include "neural/vulkan/device.h"

namespace gatelight::neural::vulkan {

/// Later commands, and the host after a fence, see everything that earlier shaders and copies wrote.
void full_barrier(const vk::raii::CommandBuffer& commands);

/// Waits for the fence and resets it.
void wait_for(const Device& device, const vk::raii::Fence& fence);

}  // namespace gatelight::neural::vulkan

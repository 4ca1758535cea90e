#pragma once
// What commands wait for. One global barrier for everything that the backend does: on a queue with compute
// and copies alone a finer one orders the same work.

#include "neural/vulkan/device.h"

namespace gatelight::neural::vulkan {

/// What comes after sees all that shaders and copies before it wrote; so does the host after a fence.
void full_barrier(const vk::raii::CommandBuffer& commands);

/// Waits for the fence and resets it.
void wait_for(const Device& device, const vk::raii::Fence& fence);

}  // namespace gatelight::neural::vulkan

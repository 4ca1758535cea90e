#pragma once
// An entry in the ring of work in progress: a batch to upload, its commands, and its results. Barriers and
// fences.

#include <cstdint>
#include <vector>

#include "neural/vulkan/buffer.h"

namespace gatelight::neural::vulkan {

struct Submission {
  explicit Submission(const Device& device, std::uint32_t stamp_count = 0);

  vk::raii::CommandPool pool;
  vk::raii::CommandBuffers commands;
  vk::raii::Fence fence;
  vk::raii::QueryPool stamps = nullptr;  ///< null without stamps, or if the device has none
  Buffer staging, batch;                 ///< the batch's block and spans on the host and on the device
  Buffer result, readback;               ///< statistics or answers
  bool under_way = false;
};

/// The device's time from the first to each of the first `count` stamps, which were written; 0 without
/// stamps.
std::vector<double> stamped_seconds(const Device& device, const Submission& submission, std::size_t count);

// One global barrier serves the whole backend: on a queue with only compute and copies, a finer barrier would
// order the same work.

/// Later commands see everything that earlier shaders and copies wrote.
void full_barrier(const vk::raii::CommandBuffer& commands);

/// Begins recording. The commands run after everything submitted before.
void begin_commands(const vk::raii::CommandBuffer& commands);
/// Ends recording and submits to the queue. The host sees what was written after the fence.
void submit_commands(const Device& device, const vk::raii::CommandBuffer& commands,
                     const vk::raii::Fence& fence);
/// Waits for the fence and resets it.
void wait_for(const Device& device, const vk::raii::Fence& fence);

}  // namespace gatelight::neural::vulkan

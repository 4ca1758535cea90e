#pragma once
// An entry in the ring of work in progress: a batch to upload, its commands, and its results. Barriers and
// fences.

#include <cstdint>

#include "neural/vulkan/buffer.h"

namespace gatelight::neural::vulkan {

/// The timestamps of a step: start, after the network, after the sort, end.
inline constexpr std::uint32_t kStamps = 4;

struct Submission {
  explicit Submission(const Device& device);

  vk::raii::CommandPool pool;
  vk::raii::CommandBuffers commands;
  vk::raii::Fence fence;
  vk::raii::QueryPool stamps = nullptr;  ///< null if the device has no timestamps
  Buffer staging, batch;                 ///< the batch's block and spans on the host and on the device
  Buffer result, readback;               ///< statistics or answers
  bool under_way = false;
};

/// The device's time between two written stamps; 0 without timestamps.
double seconds_between(const Device& device, const Submission& submission, std::uint32_t from,
                       std::uint32_t to);

// One global barrier serves the whole backend: on a queue with only compute and copies, a finer barrier would
// order the same work.

/// Later commands, and the host after a fence, see everything that earlier shaders and copies wrote.
void full_barrier(const vk::raii::CommandBuffer& commands);

/// Begins recording. The commands run after everything submitted before.
void begin_commands(const vk::raii::CommandBuffer& commands);
/// Ends recording and submits to the queue.
void submit_commands(const Device& device, const vk::raii::CommandBuffer& commands,
                     const vk::raii::Fence& fence);
/// Waits for the fence and resets it.
void wait_for(const Device& device, const vk::raii::Fence& fence);

}  // namespace gatelight::neural::vulkan

#pragma once
// A place in a ring of work under way: a batch on its way to the device, its commands, and what comes back.

#include <cstdint>

#include "neural/vulkan/buffer.h"

namespace gatelight::neural::vulkan {

/// Timestamps. Of a step: before it, after the network, after the sort, at its end. Of a chunk of a query:
/// before it, after the copy in, after the encoding, after the network, after the copy out.
inline constexpr std::uint32_t kStamps = 5;

struct Submission {
  explicit Submission(const Device& device);

  vk::raii::CommandPool pool;
  vk::raii::CommandBuffers commands;
  vk::raii::Fence fence;
  vk::raii::QueryPool stamps = nullptr;  ///< where the device has timestamps
  Buffer staging, batch;                 ///< the batch's block and spans, on the host and on the device
  Buffer result, readback;               ///< statistics or answers
  bool under_way = false;
};

/// Of the device, between two stamps that have been made; 0 where it has none.
double seconds_between(const Device& device, const Submission& submission, std::uint32_t from,
                       std::uint32_t to);

}  // namespace gatelight::neural::vulkan

#pragma once
// Blocking copies between host and device, for states but not for steps.

#include <cstddef>
#include <span>

#include "neural/vulkan/buffer.h"

namespace gatelight::neural::vulkan {

class Transfer {
 public:
  explicit Transfer(const Device& device);

  /// The copies run after everything submitted before.
  void write(const Buffer& to, std::span<const std::byte> bytes);
  void read(const Buffer& from, std::span<std::byte> bytes);
  void fill(const Buffer& to, std::uint32_t word);

 private:
  template <class Record>
  void submit(Record&& record);

  const Device& device_;
  vk::raii::CommandPool pool_;
  vk::raii::CommandBuffers commands_;
  vk::raii::Fence fence_;
  Buffer upload_, readback_;
};

}  // namespace gatelight::neural::vulkan

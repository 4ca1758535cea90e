#pragma once
// A buffer with its own memory; shaders access it by address.

#include <cstddef>
#include <cstdint>

#include "neural/vulkan/device.h"

namespace gatelight::neural::vulkan {

enum class BufferUse : std::uint8_t {
  device,    ///< read and written by shaders
  upload,    ///< written by the host, source of copies
  readback,  ///< target of copies, read by the host
};

class Buffer {
 public:
  Buffer() = default;
  /// Allocates at least one word. Throws OutOfDeviceMemory.
  Buffer(const Device& device, std::uint64_t bytes, BufferUse use);

  vk::Buffer handle() const { return *buffer_; }
  std::uint64_t bytes() const { return bytes_; }
  std::uint64_t address() const { return address_; }
  std::byte* mapped() const { return mapped_; }  ///< null for BufferUse::device

 private:
  std::uint64_t bytes_ = 0;
  std::uint64_t address_ = 0;
  std::byte* mapped_ = nullptr;
  vk::raii::DeviceMemory memory_ = nullptr;
  vk::raii::Buffer buffer_ = nullptr;
};

/// Replaces the buffer by a longer one if it is shorter than `bytes`; its content is lost then.
void reserve(const Device& device, Buffer& buffer, std::uint64_t bytes, BufferUse use);

}  // namespace gatelight::neural::vulkan

#include "neural/vulkan/buffer.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors.h"

namespace gatelight::neural::vulkan {

namespace {

using Usage = vk::BufferUsageFlagBits;
using Memory = vk::MemoryPropertyFlagBits;

struct Kind {
  vk::BufferUsageFlags usage;
  vk::MemoryPropertyFlags needed, wanted;
};

Kind kind_of(BufferUse use) {
  switch (use) {
    case BufferUse::upload:
      return {Usage::eTransferSrc, Memory::eHostVisible | Memory::eHostCoherent, {}};
    case BufferUse::readback:
      return {Usage::eTransferDst, Memory::eHostVisible | Memory::eHostCoherent, Memory::eHostCached};
    case BufferUse::device:
      break;
  }
  return {Usage::eStorageBuffer | Usage::eShaderDeviceAddress | Usage::eTransferSrc | Usage::eTransferDst,
          Memory::eDeviceLocal,
          {}};
}

}  // namespace

Buffer::Buffer(const Device& device, std::uint64_t bytes, BufferUse use)
    : bytes_((std::max<std::uint64_t>(bytes, 4) + 3) / 4 * 4) {
  const Kind kind = kind_of(use);
  const bool addressed = use == BufferUse::device;
  try {
    buffer_ = vk::raii::Buffer(device.handle(), vk::BufferCreateInfo({}, bytes_, kind.usage));
    const vk::MemoryRequirements needs = buffer_.getMemoryRequirements();
    const vk::MemoryAllocateFlagsInfo flags(vk::MemoryAllocateFlagBits::eDeviceAddress);
    vk::MemoryAllocateInfo info(needs.size,
                                device.memory_type(needs.memoryTypeBits, kind.needed, kind.wanted));
    if (addressed) info.pNext = &flags;
    memory_ = vk::raii::DeviceMemory(device.handle(), info);
    buffer_.bindMemory(*memory_, 0);
    if (addressed)
      address_ = device.handle().getBufferAddress(vk::BufferDeviceAddressInfo(*buffer_));
    else
      mapped_ = static_cast<std::byte*>(memory_.mapMemory(0, VK_WHOLE_SIZE));
  } catch (const vk::OutOfDeviceMemoryError&) {
    throw OutOfDeviceMemory(fmt::format("{}: {} MiB more do not fit", device.name(), (bytes_ >> 20) + 1));
  } catch (const vk::OutOfHostMemoryError&) {
    throw OutOfDeviceMemory(fmt::format("{}: {} MiB more do not fit", device.name(), (bytes_ >> 20) + 1));
  }
}

void reserve(const Device& device, Buffer& buffer, std::uint64_t bytes, BufferUse use) {
  if (buffer.bytes() >= bytes && buffer.bytes() != 0) return;
  buffer = {};
  buffer = Buffer(device, bytes, use);
}

}  // namespace gatelight::neural::vulkan

#include "neural/vulkan/transfer.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "neural/vulkan/barrier.h"

namespace gatelight::neural::vulkan {

namespace {

constexpr std::uint64_t kStagingBytes = std::uint64_t{8} << 20;

}  // namespace

Transfer::Transfer(const Device& device)
    : device_(device),
      pool_(device.handle(), vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eTransient |
                                                           vk::CommandPoolCreateFlagBits::eResetCommandBuffer,
                                                       device.queue_family())),
      commands_(device.handle(), vk::CommandBufferAllocateInfo(*pool_, vk::CommandBufferLevel::ePrimary, 1)),
      fence_(device.handle(), vk::FenceCreateInfo()) {}

template <class Record>
void Transfer::submit(Record&& record) {
  const vk::raii::CommandBuffer& commands = commands_.front();
  commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
  full_barrier(commands);
  record(commands);
  full_barrier(commands);
  commands.end();
  const vk::CommandBuffer handle = *commands;
  device_.queue().submit(vk::SubmitInfo({}, {}, handle), *fence_);
  wait_for(device_, fence_);
}

void Transfer::write(const Buffer& to, std::span<const std::byte> bytes) {
  reserve(device_, upload_, std::min<std::uint64_t>(kStagingBytes, bytes.size()), BufferUse::upload);
  for (std::uint64_t done = 0; done < bytes.size();) {
    const std::uint64_t part = std::min<std::uint64_t>(upload_.bytes(), bytes.size() - done);
    std::memcpy(upload_.mapped(), bytes.data() + done, part);
    submit([&](const vk::raii::CommandBuffer& commands) {
      commands.copyBuffer(upload_.handle(), to.handle(), vk::BufferCopy(0, done, part));
    });
    done += part;
  }
}

void Transfer::read(const Buffer& from, std::span<std::byte> bytes) {
  reserve(device_, readback_, std::min<std::uint64_t>(kStagingBytes, bytes.size()), BufferUse::readback);
  for (std::uint64_t done = 0; done < bytes.size();) {
    const std::uint64_t part = std::min<std::uint64_t>(readback_.bytes(), bytes.size() - done);
    submit([&](const vk::raii::CommandBuffer& commands) {
      commands.copyBuffer(from.handle(), readback_.handle(), vk::BufferCopy(done, 0, part));
    });
    std::memcpy(bytes.data() + done, readback_.mapped(), part);
    done += part;
  }
}

void Transfer::fill(const Buffer& to, std::uint32_t word) {
  submit([&](const vk::raii::CommandBuffer& commands) {
    commands.fillBuffer(to.handle(), 0, VK_WHOLE_SIZE, word);
  });
}

}  // namespace gatelight::neural::vulkan

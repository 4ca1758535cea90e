#include "neural/vulkan/transfer.h"

#include <algorithm>
#include <cstring>

namespace gatelight::neural::vulkan {

namespace {

constexpr std::uint64_t kStagingBytes = std::uint64_t{8} << 20;

}  // namespace

template <class Record>
void Transfer::submit(Record&& record) {
  const vk::raii::CommandBuffer& commands = work_.commands.front();
  begin_commands(commands);
  record(commands);
  submit_commands(device_, commands, work_.fence);
  wait_for(device_, work_.fence);
}

void Transfer::write(const Buffer& to, std::span<const std::byte> bytes) {
  reserve(device_, work_.staging, std::min<std::uint64_t>(kStagingBytes, bytes.size()), BufferUse::upload);
  for (std::uint64_t done = 0; done < bytes.size();) {
    const std::uint64_t part = std::min<std::uint64_t>(work_.staging.bytes(), bytes.size() - done);
    std::memcpy(work_.staging.mapped(), bytes.data() + done, part);
    submit([&](const vk::raii::CommandBuffer& commands) {
      commands.copyBuffer(work_.staging.handle(), to.handle(), vk::BufferCopy(0, done, part));
    });
    done += part;
  }
}

void Transfer::read(const Buffer& from, std::span<std::byte> bytes) {
  reserve(device_, work_.readback, std::min<std::uint64_t>(kStagingBytes, bytes.size()), BufferUse::readback);
  for (std::uint64_t done = 0; done < bytes.size();) {
    const std::uint64_t part = std::min<std::uint64_t>(work_.readback.bytes(), bytes.size() - done);
    submit([&](const vk::raii::CommandBuffer& commands) {
      commands.copyBuffer(from.handle(), work_.readback.handle(), vk::BufferCopy(done, 0, part));
    });
    std::memcpy(bytes.data() + done, work_.readback.mapped(), part);
    done += part;
  }
}

void Transfer::fill(const Buffer& to, std::uint32_t word) {
  submit([&](const vk::raii::CommandBuffer& commands) {
    commands.fillBuffer(to.handle(), 0, VK_WHOLE_SIZE, word);
  });
}

}  // namespace gatelight::neural::vulkan

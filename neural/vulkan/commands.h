#pragma once
// A command buffer being recorded for one model and batch.

#include <span>

#include "neural/vulkan/blocks.h"
#include "neural/vulkan/buffer.h"
#include "neural/vulkan/machine.h"

namespace gatelight::neural::vulkan {

class Commands {
 public:
  /// Begins it, after everything submitted before.
  Commands(const vk::raii::CommandBuffer& buffer, Machine& machine, Address model, Address batch);

  /// So many workgroups; the shader's spare ones return at once.
  void dispatch(Shader shader, std::span<const std::uint32_t> constants, std::uint64_t groups,
                std::uint32_t argument = 0, std::uint32_t other = 0);
  void barrier();
  void copy(const Buffer& from, const Buffer& to, std::uint64_t bytes);
  void fill(const Buffer& to, std::uint32_t word);
  /// Where there are timestamps.
  void reset(const vk::raii::QueryPool& pool, std::uint32_t count);
  void stamp(const vk::raii::QueryPool& pool, std::uint32_t number);
  /// Ends it and hands it to the queue.
  void submit(const vk::raii::Fence& fence);

 private:
  const vk::raii::CommandBuffer& buffer_;
  Machine& machine_;
  PushBlock push_;
};

/// Groups of kWorkgroupThreads.
constexpr std::uint64_t groups_for(std::uint64_t threads) {
  return (threads + kWorkgroupThreads - 1) / kWorkgroupThreads;
}

}  // namespace gatelight::neural::vulkan

#pragma once
// Records a command buffer for one model and batch.

#include <span>

#include "neural/vulkan/blocks.h"
#include "neural/vulkan/buffer.h"
#include "neural/vulkan/machine.h"

namespace gatelight::neural::vulkan {

class Commands {
 public:
  /// Begins recording. The commands run after everything submitted before.
  Commands(const vk::raii::CommandBuffer& buffer, Machine& machine, Address model, Address batch);

  /// Later dispatches read another batch of the model.
  void read_batch(Address batch) { push_.batch = batch; }
  /// Dispatches at least `groups` workgroups; the shader must return from surplus ones.
  void dispatch(Shader shader, std::span<const std::uint32_t> constants, std::uint64_t groups,
                std::uint32_t argument = 0, std::uint32_t other = 0);
  void barrier();
  void copy(const Buffer& from, const Buffer& to, std::uint64_t bytes);
  void fill(const Buffer& to, std::uint32_t word);
  /// These two do nothing if the device has no timestamps.
  void reset(const vk::raii::QueryPool& pool, std::uint32_t count);
  void stamp(const vk::raii::QueryPool& pool, std::uint32_t number);
  /// Ends recording and submits to the queue.
  void submit(const vk::raii::Fence& fence);

 private:
  const vk::raii::CommandBuffer& buffer_;
  Machine& machine_;
  PushBlock push_;
};

/// Number of workgroups of kWorkgroupThreads threads.
constexpr std::uint64_t groups_for(std::uint64_t threads) {
  return (threads + kWorkgroupThreads - 1) / kWorkgroupThreads;
}

}  // namespace gatelight::neural::vulkan

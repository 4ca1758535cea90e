#include "neural/vulkan/commands.h"

#include <algorithm>

#include "neural/vulkan/submission.h"

namespace gatelight::neural::vulkan {

Commands::Commands(const vk::raii::CommandBuffer& buffer, Machine& machine, Address model, Address batch)
    : buffer_(buffer), machine_(machine) {
  push_.model = model;
  push_.batch = batch;
  begin_commands(buffer_);
  ++machine_.work().barriers;
}

void Commands::dispatch(Shader shader, std::span<const std::uint32_t> constants, std::uint64_t groups,
                        std::uint32_t argument, std::uint32_t other) {
  if (groups == 0) return;
  push_.argument = argument;
  push_.other = other;
  Pipelines& pipelines = machine_.pipelines();
  buffer_.bindPipeline(vk::PipelineBindPoint::eCompute, pipelines.get(shader, constants));
  buffer_.pushConstants<PushBlock>(pipelines.layout(), vk::ShaderStageFlagBits::eCompute, 0, push_);
  const std::uint64_t across = std::min<std::uint64_t>(groups, machine_.device().limits().groups);
  const std::uint64_t down = (groups + across - 1) / across;
  buffer_.dispatch(static_cast<std::uint32_t>(across), static_cast<std::uint32_t>(down), 1);
  ++machine_.work().dispatches;
}

void Commands::barrier() {
  full_barrier(buffer_);
  ++machine_.work().barriers;
}

void Commands::copy(const Buffer& from, const Buffer& to, std::uint64_t bytes) {
  buffer_.copyBuffer(from.handle(), to.handle(), vk::BufferCopy(0, 0, bytes));
  if (from.mapped() != nullptr) machine_.work().bytes_to_device += bytes;
  if (to.mapped() != nullptr) machine_.work().bytes_from_device += bytes;
}

void Commands::fill(const Buffer& to, std::uint32_t word) {
  buffer_.fillBuffer(to.handle(), 0, VK_WHOLE_SIZE, word);
}

void Commands::reset(const vk::raii::QueryPool& pool, std::uint32_t count) {
  if (*pool) buffer_.resetQueryPool(*pool, 0, count);
}

void Commands::stamp(const vk::raii::QueryPool& pool, std::uint32_t number) {
  if (*pool) buffer_.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *pool, number);
}

void Commands::submit(const vk::raii::Fence& fence) {
  machine_.count_submission();
  submit_commands(machine_.device(), buffer_, fence);
  ++machine_.work().barriers;
}

}  // namespace gatelight::neural::vulkan

#include "neural/vulkan/pipelines.h"

#include "neural/vulkan/blocks.h"

namespace gatelight::neural::vulkan {

namespace {

vk::raii::PipelineLayout make_layout(const Device& device) {
  const vk::PushConstantRange push(vk::ShaderStageFlagBits::eCompute, 0, sizeof(PushBlock));
  return {device.handle(), vk::PipelineLayoutCreateInfo({}, {}, push)};
}

}  // namespace

Pipelines::Pipelines(const Device& device)
    : device_(device), layout_(make_layout(device)), cache_(device.handle(), vk::PipelineCacheCreateInfo()) {}

vk::Pipeline Pipelines::get(Shader shader, std::span<const std::uint32_t> constants) {
  std::pair key(shader, std::vector<std::uint32_t>(constants.begin(), constants.end()));
  auto found = pipelines_.find(key);
  if (found == pipelines_.end()) found = pipelines_.emplace(std::move(key), make(shader, constants)).first;
  return *found->second;
}

vk::raii::Pipeline Pipelines::make(Shader shader, std::span<const std::uint32_t> constants) {
  const std::span<const std::uint32_t> code = shader_code(shader);
  const vk::raii::ShaderModule module(device_.handle(),
                                      vk::ShaderModuleCreateInfo({}, code.size_bytes(), code.data()));
  std::vector<vk::SpecializationMapEntry> entries;
  for (std::uint32_t i = 0; i < constants.size(); ++i) entries.emplace_back(i, 4 * i, 4);
  const vk::SpecializationInfo specialization(static_cast<std::uint32_t>(entries.size()), entries.data(),
                                              constants.size_bytes(), constants.data());
  const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main",
                                                &specialization);
  return {device_.handle(), cache_, vk::ComputePipelineCreateInfo({}, stage, *layout_)};
}

}  // namespace gatelight::neural::vulkan

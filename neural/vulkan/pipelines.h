#pragma once
// Pipelines of the shaders, compiled on first use.

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "neural/vulkan/device.h"
#include "neural/vulkan/shaders.h"

namespace gatelight::neural::vulkan {

class Pipelines {
 public:
  explicit Pipelines(const Device& device);

  vk::PipelineLayout layout() const { return *layout_; }
  /// `constants` are the shader's specialization constants, starting with number 0.
  vk::Pipeline get(Shader shader, std::span<const std::uint32_t> constants);

 private:
  vk::raii::Pipeline make(Shader shader, std::span<const std::uint32_t> constants);

  const Device& device_;
  vk::raii::PipelineLayout layout_;
  vk::raii::PipelineCache cache_;
  std::map<std::pair<Shader, std::vector<std::uint32_t>>, vk::raii::Pipeline> pipelines_;
};

}  // namespace gatelight::neural::vulkan

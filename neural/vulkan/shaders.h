#pragma once
// The SPIR-V that the build compiles from shaders/*.comp.

#include <cstdint>
#include <span>

namespace gatelight::neural::vulkan {

enum class Shader : std::uint8_t {
  answer,
  count_step,
  count_triangles,
  encode,
  pack_network,
  sort_clear,
  sort_count,
  sort_scatter,
  start_mean,
  sum_pieces,
  train_network,
  update_network,
  update_nodes,
};

std::span<const std::uint32_t> shader_code(Shader shader);

}  // namespace gatelight::neural::vulkan

#include "neural/vulkan/shaders.h"

namespace gatelight::neural::vulkan {

std::span<const std::uint32_t> shader_code(Shader shader) {
  switch (shader) {
#include "shader_cases.inc"  // one case for each shader of CMakeLists.txt, which writes this file
  }
  return {};
}

}  // namespace gatelight::neural::vulkan

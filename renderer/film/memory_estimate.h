#pragma once
// How much memory a picture will take, before anything is built.

#include <cstddef>
#include <string_view>

#include "renderer/settings/options.h"
#include "scene/scene.h"

namespace gatelight::renderer {

struct MemoryEstimate {
  std::size_t geometry = 0;  ///< vertices, indices and decoded images, already there
  std::size_t bvh = 0;
  std::size_t textures = 0;
  std::size_t lights = 0;
  std::size_t film = 0;

  std::size_t total() const { return geometry + bvh + textures + lights + film; }
};

MemoryEstimate estimate_memory(const scene::Scene& scene, const RenderOptions& options);

/// Throws OutOfMemory where `all` of rendering `what` needs more than options.memory_limit_bytes, or `more`,
/// what is not taken yet, than memory_room() leaves.
void require_memory(std::string_view what, const RenderOptions& options, std::size_t all, std::size_t more);

}  // namespace gatelight::renderer

#pragma once
// How much memory a picture will take, before anything is built.

#include <cstddef>

#include "renderer/options.h"
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

}  // namespace gatelight::renderer

#pragma once
// Estimates the memory that a picture needs, before anything is built.

#include <cstddef>
#include <string_view>

#include "renderer/settings/options.h"
#include "scene/scene.h"

namespace gatelight::renderer {

struct MemoryEstimate {
  std::size_t geometry = 0;  ///< vertices, indices and decoded images, which are already allocated
  std::size_t bvh = 0;
  std::size_t textures = 0;
  std::size_t lights = 0;
  std::size_t film = 0;

  std::size_t total() const { return geometry + bvh + textures + lights + film; }
};

/// The least memory of Open Image Denoise. Less makes it slow, and saves nothing.
inline constexpr std::size_t kDenoiserBytes = std::size_t{256} << 20;

MemoryEstimate estimate_memory(const scene::Scene& scene, const RenderOptions& options);

/// Throws OutOfMemory if `all`, the bytes that rendering `what` needs, exceeds options.memory_limit_bytes.
/// Also throws if `more`, the bytes that are not allocated yet, exceeds what memory_room() leaves.
void require_memory(std::string_view what, const RenderOptions& options, std::size_t all, std::size_t more);

}  // namespace gatelight::renderer

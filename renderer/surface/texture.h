#pragma once
// Filtered texture lookups from mip pyramids, which are built once from the scene's decoded images.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "renderer/surface/texture_pyramid.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// Thread-safe after construction.
class Textures {
 public:
  explicit Textures(const scene::Scene& scene);

  /// A bilinear lookup. The result is linear RGBA in [0, 1]. `uv` is the mesh's coordinate of the slot's set,
  /// before the slot's transform. `footprint` is the width of the ray's cone in untransformed uv units; 0
  /// reads the finest mip level. `u_level` in [0, 1) chooses one of the two nearest mip levels. The mean over
  /// u_level is the trilinear lookup.
  Vec4 lookup(const scene::TextureSlot& slot, Encoding encoding, const Vec2& uv, float footprint,
              float u_level) const;

  /// The mean of the whole image in linear RGBA, for estimates of power.
  Vec4 mean(const scene::TextureSlot& slot, Encoding encoding) const;

  std::size_t bytes() const;

 private:
  struct Lookup {
    /// By Encoding; null where no material needs it. A pyramid of 16 bits has its own place, so that lookups
    /// in 8 bits need no test.
    const TexturePyramid* pyramid[2] = {nullptr, nullptr};
    const TexturePyramid* pyramid_16[2] = {nullptr, nullptr};
    scene::Texture texture;
  };

  std::vector<std::array<std::unique_ptr<TexturePyramid>, 2>> pyramids_;  ///< by image and Encoding
  std::vector<Lookup> lookups_;  ///< one for each texture of the scene
};

}  // namespace gatelight::renderer

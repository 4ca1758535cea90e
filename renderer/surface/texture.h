#pragma once
// Filtered texture lookups from mip pyramids, which are built once from the scene's decoded images.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace gatelight::renderer {

/// How the bytes of a colour channel are decoded. Alpha is always linear.
enum class Encoding : std::uint8_t { linear, srgb };

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
  struct Level {
    int width = 0;
    int height = 0;
    std::size_t offset = 0;  ///< into Pyramid::texels
  };
  struct Pyramid {
    std::vector<Level> levels;
    std::vector<std::uint32_t> texels;  ///< RGBA8, R in the low byte, colours in the pyramid's encoding
    Vec4 mean = Vec4::Zero();
  };
  struct Lookup {
    const Pyramid* pyramid[2] = {nullptr, nullptr};  ///< by Encoding; null where no material needs it
    scene::Texture texture;
  };

  std::vector<std::array<std::unique_ptr<Pyramid>, 2>> pyramids_;  ///< by image and Encoding
  std::vector<Lookup> lookups_;                                    ///< one for each texture of the scene
};

}  // namespace gatelight::renderer

#pragma once
// Filtered texture lookups: mip pyramids built once from the scene's decoded images.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace gatelight::renderer {

using scene::Color;
using scene::Vec2;
using scene::Vec3;
using scene::Vec4;

/// How the bytes of a colour channel turn into numbers. Alpha is always linear.
enum class Encoding : std::uint8_t { linear, srgb };

/// Thread-safe after construction.
class Textures {
 public:
  explicit Textures(const scene::Scene& scene);

  /// Bilinear lookup, RGBA in [0, 1], linear. `uv` is the mesh's coordinate of the slot's set, before the
  /// slot's transform. `footprint` is the width of the ray's cone measured in untransformed uv units (0:
  /// finest level); the level is chosen between the two nearest ones with probability u_level in [0, 1),
  /// whose mean over u_level is the trilinear lookup.
  Vec4 lookup(const scene::TextureSlot& slot, Encoding encoding, const Vec2& uv, float footprint,
              float u_level) const;

  /// Mean of the whole picture, linear RGBA: for estimates of power.
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
    const Pyramid* pyramid[2] = {nullptr, nullptr};  ///< by Encoding; built only where a material asks for it
    scene::Wrap wrap_s = scene::Wrap::repeat;
    scene::Wrap wrap_t = scene::Wrap::repeat;
    bool nearest = false;
  };

  std::vector<std::unique_ptr<Pyramid>> pyramids_;
  std::vector<Lookup> lookups_;  ///< one for each texture of the scene
};

}  // namespace gatelight::renderer

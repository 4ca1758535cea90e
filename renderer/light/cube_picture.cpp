#include "renderer/light/cube_picture.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "renderer/image/srgb.h"

namespace gatelight::renderer {
namespace {

constexpr int kMaxHeight = 4096;
/// Number of directions of a texel in each of its two coordinates.
constexpr int kSubTexels = 2;

/// A face's linear colours.
struct Face {
  int width = 0, height = 0;
  std::vector<Color> texels;

  explicit Face(const scene::Image& image) : width(image.width), height(image.height) {
    const auto channels = static_cast<std::size_t>(image.channels);
    const bool divided = image.channels == 2 || image.channels == 4;
    texels.resize(image.pixels.size() / channels);
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const std::uint8_t* const p = &image.pixels[channels * i];
      for (int c = 0; c < 3; ++c) texels[i][c] = kSrgbToLinear[p[image.channels < 3 ? 0 : c]];
      if (divided) texels[i] *= 255.0f / static_cast<float>(std::max<int>(p[channels - 1], 1));
    }
  }

  /// Interpolates between texel centres. u is to the right and v is down, in [0, 1].
  Color at(float u, float v) const {
    const float x = std::clamp(u * static_cast<float>(width) - 0.5f, 0.0f, static_cast<float>(width - 1));
    const float y = std::clamp(v * static_cast<float>(height) - 0.5f, 0.0f, static_cast<float>(height - 1));
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
    const float s = x - static_cast<float>(x0), t = y - static_cast<float>(y0);
    const auto texel = [&](int column, int row) {
      return texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(column)];
    };
    return (1.0f - t) * ((1.0f - s) * texel(x0, y0) + s * texel(x1, y0)) +
           t * ((1.0f - s) * texel(x0, y1) + s * texel(x1, y1));
  }
};

/// The colour of the cube in a direction, seen from inside.
Color look_up(const std::array<Face, 6>& faces, const Vec3& d) {
  int axis = 0;
  d.cwiseAbs().maxCoeff(&axis);
  const bool negative = d[axis] < 0.0f;
  Vec3 forward = Vec3::Zero(), up = Vec3::UnitY();
  forward[axis] = negative ? -1.0f : 1.0f;
  if (axis == 1) up = Vec3(0.0f, 0.0f, negative ? 1.0f : -1.0f);
  const Vec3 right = forward.cross(up);
  const float depth = std::abs(d[axis]);
  return faces[static_cast<std::size_t>(2 * axis + (negative ? 1 : 0))].at(0.5f + 0.5f * d.dot(right) / depth,
                                                                           0.5f - 0.5f * d.dot(up) / depth);
}

}  // namespace

EnvironmentPicture make_cube_picture(const scene::ImageBasedLight& light, float scale) {
  const auto face = [&](std::size_t i) { return Face(light.faces[i]); };
  const std::array<Face, 6> faces = {face(0), face(1), face(2), face(3), face(4), face(5)};
  int side = 1;
  for (const Face& f : faces) side = std::max({side, f.width, f.height});
  const int height = std::min(2 * side, kMaxHeight), width = 2 * height;
  const float factor = scale * light.intensity / (kSubTexels * kSubTexels);
  std::vector<Color> texels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      Color sum = Color::Zero();
      for (int k = 0; k < kSubTexels * kSubTexels; ++k) {
        const float u = static_cast<float>(x) + (static_cast<float>(k % kSubTexels) + 0.5f) / kSubTexels;
        const float v = static_cast<float>(y) + (static_cast<float>(k / kSubTexels) + 0.5f) / kSubTexels;
        const float theta = kPi * v / static_cast<float>(height);
        const float phi = 2.0f * kPi * (u / static_cast<float>(width) - 0.5f);
        // The centre is -z, and +x is to its right.
        const Vec3 d(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
        sum += look_up(faces, light.rotation.transpose() * d);
      }
      texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
          (sum * factor).min(kLargestRadiance);
    }
  });
  return {width, height, std::move(texels)};
}

}  // namespace gatelight::renderer

#pragma once
// A latitude-longitude picture as a function on the sphere: lookups, a pyramid for filtered lookups, and
// sampling.
//
// Radiance is interpolated between texel centres, with wrap-around in longitude and clamping at the poles.
// The pdf is constant on each texel. The weight of a texel is the exact integral of the interpolated
// luminance in the picture's plane, times its solid angle. Along each axis that is 3/4 of the texel and 1/8
// of each neighbour. So every texel with any light has a pdf above zero. Within a texel directions are
// uniform per solid angle, which needs no sine and has no singular poles.

#include <cstddef>
#include <vector>

#include "base/math.h"

namespace gatelight::renderer {

struct EnvironmentSample {
  Vec3 wi = Vec3::Zero();
  Color radiance{0.0f, 0.0f, 0.0f};
  float pdf = 0.0f;  ///< per solid angle; 0 means no sample
};

/// Larger radiance is clamped, so that sums of a whole picture and products with a throughput stay finite.
inline constexpr float kLargestRadiance = 1e30f;

class EnvironmentPicture {
 public:
  /// The first row is the top. Values are finite and not negative. Directions are in the picture's own frame.
  EnvironmentPicture(int width, int height, std::vector<Color> texels);

  /// Filtered for a ray cone with this full angle in radians; 0 reads the finest level.
  Color radiance(const Vec3& direction, float cone_angle = 0.0f) const;
  EnvironmentSample sample(const Vec2& u) const;
  float pdf(const Vec3& direction) const;
  Color mean() const { return mean_; }
  std::size_t bytes() const;

 private:
  struct Level {
    int width = 0;
    int height = 0;
    std::vector<Color> texels;
  };

  static Color bilinear(const Level& level, const Vec2& uv);
  static Level halve(const Level& source);
  void build_density();

  std::vector<Level> levels_;  ///< from the finest to 1x1
  Color mean_{0.0f, 0.0f, 0.0f};
  std::vector<float> row_cosines_;  ///< height + 1: cosine of the polar angle at the upper edge of each row
  std::vector<float> row_cdf_;      ///< height + 1
  std::vector<float> column_cdf_;   ///< (width + 1) for each row
  std::vector<float> density_;      ///< per solid angle, one for each texel
};

}  // namespace gatelight::renderer

#pragma once
// What reconstruction reads of a picture.

#include <vector>

#include "renderer/image/picture.h"

namespace gatelight::renderer {

/// Pixels in rows from the top. Colours, variances, normals: 3 floats a pixel. All values are finite.
struct SampledPicture {
  /// The samples of a pixel go to the halves in turn.
  struct Half {
    std::vector<float> color;     ///< means, linear
    std::vector<float> variance;  ///< of the means
    std::vector<float> cache;     ///< the picture that a cache gives for these samples; empty without one
    /// What the camera sees itself of lamps and environment. It has no noise but that of edges, so it is not
    /// fitted: the other members leave it out. Empty where it is not told apart.
    std::vector<float> seen;
  };

  int width = 0;
  int height = 0;
  Half halves[2];
  std::vector<float> counts;    ///< samples a pixel; pixels without any are filled
  std::vector<float> coverage;  ///< share of the samples that hit a surface
  std::vector<float> behind;    ///< share that the cache knows behind the guides' surface; empty: none
  // Means over a pixel's samples, at the first surface that is neither a mirror nor clear; zero where nothing
  // was hit.
  std::vector<float> albedo;
  std::vector<float> normal;
  std::vector<float> depth;  ///< in metres, over the samples that hit
};

/// Takes the values of the layers that --aov reconstruction writes out of a picture, where they are empty
/// afterwards. Values that are not finite count as 0, and a pixel with such a colour as one without samples.
/// Throws ImageError, which names the layer that is missing.
SampledPicture take_samples(Picture& picture);

}  // namespace gatelight::renderer

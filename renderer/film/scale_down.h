#pragma once
// Reduces a picture by an integer factor with the pixel filter.

#include <span>
#include <vector>

#include "renderer/settings/enums.h"

namespace gatelight::renderer {

class ScaleDown {
 public:
  /// `factor`: pixels of the large picture along the edge of one of the small one; 1 changes nothing. `width`
  /// in pixels of the small one, as resolve_filter_width() takes it.
  ScaleDown(int factor, PixelFilter filter, float width);

  int factor() const { return factor_; }
  /// Number of rows of the large picture beyond its own that a row of the small one depends on, in each
  /// direction.
  int reach() const { return reach_; }

  /// The rows begin <= y < end of the small picture. `values`: rows of the large one from `top` on,
  /// `channels` numbers a pixel; those within reach() that the large picture of `width` x `height` pixels
  /// has.
  std::vector<float> scale(std::span<const float> values, int channels, int width, int height, int top,
                           int begin, int end) const;

 private:
  int factor_;
  int reach_;
  std::vector<float> weights_;  ///< of the pixels from -reach on, around each pixel of the small picture
};

}  // namespace gatelight::renderer

#pragma once
// How far apart the nodes of each instance shall lie: as far as the camera's picture of it allows.

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/settings/options.h"
#include "renderer/surface/surface.h"

namespace gatelight::renderer {

struct NodeSpacing {
  float spacing = 0.0f;       ///< metres, where the middle one of the points lies
  std::vector<float> scales;  ///< for each instance: its spacing over that one; powers of two
};

/// Widths that a pixel has on the instances of a scene.
class PixelWidths {
 public:
  explicit PixelWidths(std::size_t instances) : seen_(instances), met_(instances) {}

  /// A point that the camera sees, straight or through panes.
  void add_seen(std::uint32_t instance, float pixel_width) { seen_[instance].push_back(pixel_width); }
  /// A vertex of a path; asked of instances that the camera does not see itself.
  void add_met(std::uint32_t instance, float pixel_width) { met_[instance].push_back(pixel_width); }

  /// The spacing of an instance is `pixels` times the median width of a pixel on it, rounded to the overall
  /// one times a power of two: paths begin as often in each of its patches wherever it stands. It is greater
  /// where little of a large instance is near: its area (square metres, one for each instance) holds no more
  /// than a few nodes for each point that was added. Instances that nothing met have a scale of 1. Zero where
  /// no width is above zero.
  NodeSpacing spacing(float pixels, std::span<const double> areas) const;

 private:
  std::vector<std::vector<float>> seen_, met_;
};

}  // namespace gatelight::renderer

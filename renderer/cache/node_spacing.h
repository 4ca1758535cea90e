#pragma once
// The node spacing of each instance, from the width of a pixel on it.

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/settings/options.h"
#include "renderer/surface/surface.h"

namespace gatelight::renderer {

struct NodeSpacing {
  float spacing = 0.0f;       ///< metres, for the median width of a pixel
  std::vector<float> scales;  ///< for each instance: its spacing over `spacing`; powers of two
};

/// Widths of a pixel on the instances of a scene.
class PixelWidths {
 public:
  explicit PixelWidths(std::size_t instances) : camera_(instances), bounce_(instances) {}

  /// A point that the camera sees, directly or through panes.
  void add_camera(std::uint32_t instance, float pixel_width) { camera_[instance].push_back(pixel_width); }
  /// A vertex of a path; used for instances that the camera does not see.
  void add_met(std::uint32_t instance, float pixel_width) { bounce_[instance].push_back(pixel_width); }

  /// The spacing of an instance is `pixels` times the median width of a pixel on it, rounded to the overall
  /// spacing times a power of two. So paths begin about equally often in each of its patches, at any
  /// distance. The spacing is larger where only a small part of a large instance is near: its area (`areas`,
  /// square metres) then has at most a few nodes for each point that was added. Instances without points have
  /// a scale of 1. The spacing is zero where no width is above zero.
  NodeSpacing spacing(float pixels, std::span<const double> areas) const;

 private:
  std::vector<std::vector<float>> camera_, bounce_;
};

}  // namespace gatelight::renderer

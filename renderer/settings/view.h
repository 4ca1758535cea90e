#pragma once
// A camera with its lens.

#include "scene/scene.h"

namespace gatelight::renderer {

/// The camera sees what is between two planes perpendicular to its view, or between two spheres in a
/// panorama.
struct Clip {
  float near = 0.0f;  ///< metres
  float far = kInfinity;

  bool operator==(const Clip&) const = default;
};

struct View : scene::Camera {
  bool panorama = false;        ///< all directions: latitude-longitude, -z of the camera in the middle
  float lens_radius = 0.0f;     ///< metres; 0: a pinhole, all is sharp
  float focus_distance = 0.0f;  ///< metres along the view; 0: the distance in the picture's middle
  int blades = 0;               ///< corners of the aperture; 0: round
  Clip clip;

  View() = default;
  View(const scene::Camera& camera) : scene::Camera(camera) {}
};

}  // namespace gatelight::renderer

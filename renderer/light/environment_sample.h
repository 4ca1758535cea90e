#pragma once

#include "scene/math.h"

namespace gatelight::renderer {

struct EnvironmentSample {
  scene::Vec3 wi = scene::Vec3::Zero();
  scene::Color radiance{0.0f, 0.0f, 0.0f};
  float pdf = 0.0f;  ///< per solid angle; 0 means no sample
};

}  // namespace gatelight::renderer

#pragma once

#include <string>

#include "scene/math.h"

namespace gatelight::renderer {

struct EnvironmentOptions {
  std::string file;                         ///< EXR or HDR picture, latitude-longitude; empty: constant
  scene::Color constant{0.0f, 0.0f, 0.0f};  ///< radiance, where there is no file
  float rotation_degrees = 0.0f;            ///< about +y, counter-clockwise seen from above
  float scale = 1.0f;

  bool none() const { return file.empty() && (constant == 0.0f).all(); }
};

}  // namespace gatelight::renderer

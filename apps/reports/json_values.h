#pragma once
// Values of ours as JSON.

#include <nlohmann/json.hpp>

#include "scene/math.h"

namespace gatelight::apps {

inline nlohmann::ordered_json triple(const scene::Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace gatelight::apps

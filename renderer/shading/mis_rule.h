#pragma once
// Multiple importance sampling of lights and directions (Veach 1997).

#include "renderer/settings/enums.h"

namespace gatelight::renderer {

/// MIS weights of light sampling and BSDF sampling.
struct MisRule {
  DirectLight direct = DirectLight::mis;
  MisHeuristic heuristic = MisHeuristic::power;

  float light_weight(float light_pdf, float bsdf_pdf) const {
    return weight(DirectLight::nee, DirectLight::bsdf, light_pdf, bsdf_pdf);
  }
  float bsdf_weight(float bsdf_pdf, float light_pdf) const {
    if (light_pdf <= 0.0f) return 1.0f;
    return weight(DirectLight::bsdf, DirectLight::nee, bsdf_pdf, light_pdf);
  }

 private:
  float weight(DirectLight mine, DirectLight other, float pdf, float other_pdf) const {
    if (direct == mine) return 1.0f;
    if (direct == other) return 0.0f;
    const float ratio = other_pdf / pdf;
    return heuristic == MisHeuristic::balance ? 1.0f / (1.0f + ratio) : 1.0f / (1.0f + ratio * ratio);
  }
};

}  // namespace gatelight::renderer

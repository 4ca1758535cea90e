#pragma once
// The reflectance of a plane interface.

#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "renderer/bsdf/bsdf_constants.h"

namespace gatelight::renderer {

/// (1 - c)^5, the weight of Schlick's approximation.
inline float schlick_weight(float cos_theta) {
  const float x = std::clamp(1.0f - cos_theta, 0.0f, 1.0f);
  const float x2 = x * x;
  return x2 * x2 * x;
}

/// The unpolarised Fresnel reflectance. `eta` is the index behind the interface divided by the index on the
/// side of the ray. Sets `cos_t`, the cosine of the refracted ray. At total internal reflection cos_t is 0
/// and the reflectance is 1.
inline float fresnel_dielectric(float cos_i, float eta, float& cos_t) {
  const float cos_t2 = 1.0f - (1.0f - cos_i * cos_i) / (eta * eta);
  if (!(cos_t2 > 0.0f)) {
    cos_t = 0.0f;
    return 1.0f;
  }
  cos_t = std::sqrt(cos_t2);
  const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  const float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

inline float coat_fresnel(float cos_theta) {
  return kCoatF0 + (1.0f - kCoatF0) * schlick_weight(cos_theta);
}

inline float dielectric_f0(float ior) {
  const float root = (ior - 1.0f) / (ior + 1.0f);
  return root * root;
}

}  // namespace gatelight::renderer

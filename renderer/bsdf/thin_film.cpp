#include "renderer/bsdf/thin_film.h"

#include <algorithm>
#include <cmath>

#include "renderer/bsdf/fresnel.h"
#include "renderer/sampling/color_matching.h"

namespace gatelight::renderer {
namespace {

constexpr float kThinnest = 0.03f;  ///< nanometres

/// The reflectance at normal incidence between two indices.
template <class T>
T between(const T& inside, float outside) {
  const T root = (inside - outside) / (inside + outside);
  return root * root;
}

/// The colour of a cosine of this optical path difference over the spectrum, and of its shift, in radians:
/// Gaussians that fit the sensitivities of the eye, in Fourier space (equation 10 of the paper).
Color sensitivity(float difference_nm, const Color& shift) {
  const float phase = 2.0f * kPi * difference_nm * 1e-9f;
  const Color value(5.4856e-13f, 4.4201e-13f, 5.2481e-13f), position(1.6810e+06f, 1.7953e+06f, 2.2084e+06f),
      variance(4.3278e+09f, 9.3046e+09f, 6.6121e+09f);
  Color xyz = value * (2.0f * kPi * variance).sqrt() * (position * phase + shift).cos() *
              (-phase * phase * variance).exp();
  // The second lobe of x.
  xyz.x() += 9.7470e-14f * std::sqrt(2.0f * kPi * 4.5282e+09f) * std::cos(2.2399e+06f * phase + shift.x()) *
             std::exp(-4.5282e+09f * phase * phase);
  xyz /= 1.0685e-7f;
  static const Eigen::Matrix3f to_rec709 = rec709_from_xyz().cast<float>();
  return (to_rec709 * xyz.matrix()).array();
}

}  // namespace

Color ThinFilm::reflectance(float cosine, const Color& base_f0) const {
  const float cos_1 = std::clamp(cosine, 0.0f, 1.0f);
  const float ratio = outside_ior / ior;
  const float cos2_2 = 1.0f - ratio * ratio * (1.0f - cos_1 * cos_1);
  if (!(cos2_2 > 0.0f)) return Color::Ones();  // total reflection
  const float cos_2 = std::sqrt(cos2_2);

  const float r0 = between(ior, outside_ior);
  const float r12 = r0 + (1.0f - r0) * schlick_weight(cos_1), t121 = 1.0f - r12;
  const Color root = base_f0.max(0.0f).min(0.9999f).sqrt();
  const Color base_ior = (1.0f + root) / (1.0f - root);
  const Color r1 = between(base_ior, ior);
  const Color r23 = r1 + (1.0f - r1) * schlick_weight(cos_2);

  const float phi21 = ior < outside_ior ? 0.0f : kPi;
  const Color phi = phi21 + (base_ior < ior).select(Color::Constant(kPi), Color::Zero());
  const float difference = 2.0f * ior * thickness * cos_2;

  const Color r123 = (r12 * r23).max(1e-5f).min(0.9999f);
  const Color single = t121 * t121 * r23 / (1.0f - r123);
  Color sum = r12 + single;
  Color order = single - t121;
  for (int m = 1; m <= 2; ++m) {
    order *= r123.sqrt();
    sum += 2.0f * order * sensitivity(static_cast<float>(m) * difference, static_cast<float>(m) * phi);
  }
  return sum.max(0.0f).min(1.0f);
}

Color ThinFilm::change(float cosine, const Color& base_f0, float base_f90) const {
  const Color without = base_f0 + (base_f90 - base_f0) * schlick_weight(cosine);
  // Without thickness there is no film, which the simplified curves do not reproduce.
  const float there = std::min(thickness / kThinnest, 1.0f);
  return weight * there * (reflectance(cosine, base_f0) - without);
}

}  // namespace gatelight::renderer

#pragma once
// Quadrature over the unit square of visible normals, for the albedo tables.

#include <array>

#include "renderer/bsdf_ggx.h"

namespace gatelight::renderer {

struct QuadratureNode {
  float u;
  float weight;
};

/// Midpoints of the variable v in u = v^2 (3 - 2 v): at grazing incidence the albedo's integrand is singular
/// in corners of the square, and the smooth step spends its nodes there. The weights add up to one.
template <int count>
std::array<QuadratureNode, count> make_quadrature() {
  std::array<QuadratureNode, count> nodes;
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    const double v = (i + 0.5) / count;
    nodes[i] = {static_cast<float>(v * v * (3.0 - 2.0 * v)), static_cast<float>(v * (1.0 - v))};
    sum += v * (1.0 - v);
  }
  for (QuadratureNode& node : nodes) node.weight /= static_cast<float>(sum);
  return nodes;
}

/// Calls f(h, weight) for visible normals of wo = (sin, 0, cosine) on one side of its plane; mirrored, they
/// make the whole distribution. `heights` nodes in one coordinate, a third of them in the other.
template <int heights, class F>
void for_visible_normals(float alpha, const Vec3& wo, F&& f) {
  static const auto height_nodes = make_quadrature<heights>();
  static const auto azimuth_nodes = make_quadrature<(heights + 2) / 3>();
  for (const QuadratureNode& azimuth : azimuth_nodes) {
    for (const QuadratureNode& height : height_nodes) {
      f(sample_visible_normal(alpha, wo, Vec2(0.5f * azimuth.u, height.u)), azimuth.weight * height.weight);
    }
  }
}

/// Cosine of the coordinate u in [0, 1] of the albedo tables, the inverse of u = cosine (1 + alpha) / (cosine
/// + alpha). Kept off the horizon itself.
inline float table_cosine(float u, float alpha) {
  return std::clamp(u * alpha / (1.0f + alpha - u), 1e-3f * alpha, 1.0f);
}

/// How much of the light of one node of the cosine goes to each other one, linearly interpolated.
template <int count>
class CosineMatrix {
 public:
  void add(int row, float cosine, float alpha, float amount) {
    const float x = std::min(cosine, 1.0f) * (1.0f + alpha) / (std::min(cosine, 1.0f) + alpha) * (count - 1);
    const int i = std::min(static_cast<int>(x), count - 2);
    const float s = x - static_cast<float>(i);
    cells_[row][i] += amount * (1.0f - s);
    cells_[row][i + 1] += amount * s;
  }
  float row_sum(int row, const std::array<float, count>& factors) const {
    float sum = 0.0f;
    for (int i = 0; i < count; ++i) sum += cells_[row][i] * factors[i];
    return sum;
  }

 private:
  std::array<std::array<float, count>, count> cells_{};
};

/// Iterations of Sinkhorn's balance; the change is below 1e-6 after half as many.
inline constexpr int kBalanceSteps = 24;

/// Calls f(cosine, weight) for the cosine-weighted mean over the hemisphere, with steps that get finer
/// towards the horizon. The weights add up to one.
template <class F>
void for_mean_cosines(F&& f) {
  constexpr int kSteps = 384;
  for (int i = 0; i < kSteps; ++i) {
    const float x = (static_cast<float>(i) + 0.5f) / kSteps;
    f(x * x, 4.0f * x * x * x / kSteps);
  }
}

}  // namespace gatelight::renderer

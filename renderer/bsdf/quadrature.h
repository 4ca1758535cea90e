#pragma once
// Quadrature over visible normals and cosines, for the albedo tables.

#include <array>

#include "renderer/bsdf/ggx.h"

namespace gatelight::renderer {

struct LatticePoint {
  Vec2 u;
  float weight;
};

/// Points of the unit square for sample_visible_normal(), on one side of the plane of wo (the other side is
/// symmetric): u.x is in [0, 0.5]. A Fibonacci lattice of `count` points; `previous` is the Fibonacci number
/// before `count`. A smooth step v^2 (3 - 2 v) maps both coordinates. It puts more points into the
/// corners of the square, where the integrand is singular at grazing incidence, and makes the integrand
/// periodic, which suits lattices. The kink at total reflection does no harm; a product rule with as many
/// points has an error of 2 % there.
template <int count, int previous>
const std::array<LatticePoint, count>& half_lattice() {
  static const std::array<LatticePoint, count> points = [] {
    std::array<LatticePoint, count> result;
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
      const double x = (i + 0.5) / count;
      const double y = static_cast<double>((static_cast<long>(i) * previous) % count) / count + 0.5 / count;
      result[i].u = Vec2(static_cast<float>(0.5 * x * x * (3.0 - 2.0 * x)),
                         static_cast<float>(y * y * (3.0 - 2.0 * y)));
      result[i].weight = static_cast<float>(x * (1.0 - x) * y * (1.0 - y));
      sum += x * (1.0 - x) * y * (1.0 - y);
    }
    for (LatticePoint& point : result) point.weight /= static_cast<float>(sum);
    return result;
  }();
  return points;
}

/// Calls f(h, weight) for visible normals of wo = (sin, 0, cosine) on one side of the plane y = 0; the other
/// side is symmetric.
template <int count, int previous, class F>
void for_visible_normals(float alpha, const Vec3& wo, F&& f) {
  for (const LatticePoint& point : half_lattice<count, previous>())
    f(sample_visible_normal(alpha, wo, point.u), point.weight);
}

/// The cosine for the coordinate u in [0, 1] of the albedo tables: the inverse of u = cosine (1 + alpha) /
/// (cosine + alpha). It stays above 0.
inline float table_cosine(float u, float alpha) {
  return std::clamp(u * alpha / (1.0f + alpha - u), 1e-3f * alpha, 1.0f);
}

/// The light that goes from each node of the cosine (row) to each other node (column), with linear
/// interpolation.
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

/// Iterations of Sinkhorn's balance. The change is below 1e-6 after half of them.
inline constexpr int kBalanceSteps = 24;

/// The scale s with s_i sum_j kernel_ij s_j = 1 of a symmetric kernel, by Sinkhorn's balance. `kernel` is a
/// CosineMatrix or has the same row_sum().
template <int count, class Kernel>
std::array<float, count> balance(const Kernel& kernel) {
  std::array<float, count> scale;
  scale.fill(1.0f);
  for (int step = 0; step < kBalanceSteps; ++step) {
    std::array<float, count> next;
    for (int i = 0; i < count; ++i) next[i] = std::sqrt(scale[i] / kernel.row_sum(i, scale));
    scale = next;
  }
  return scale;
}

/// Calls f(cosine, weight) for the cosine-weighted mean over the hemisphere. The steps get finer towards the
/// horizon. The weights add up to one.
template <class F>
void for_mean_cosines(F&& f) {
  constexpr int kSteps = 384;
  for (int i = 0; i < kSteps; ++i) {
    const float x = (static_cast<float>(i) + 0.5f) / kSteps;
    f(x * x, 4.0f * x * x * x / kSteps);
  }
}

}  // namespace gatelight::renderer

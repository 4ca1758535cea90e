#include "renderer/metrics/flip/exposures.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/finite_float.h"
#include "renderer/image/tonemap.h"

namespace gatelight::renderer::flip {
namespace {

constexpr float kPreExposure = 0.6f;

/// The value that the curve shows as 0.85 (t of 2021, section 3.2). It is the root of
/// (2.51 - 2.43 t) u^2 + (0.03 - 0.59 t) u - 0.14 t = 0 with u = 0.6 x.
double nearly_white() {
  constexpr double kShown = 0.85;
  const double a = 2.51 - 2.43 * kShown;
  const double b = 0.03 - 0.59 * kShown;
  const double c = -0.14 * kShown;
  return (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a) / kPreExposure;
}

/// The range is sorted and not empty.
double median(const double* first, const double* last) {
  const std::ptrdiff_t count = last - first;
  return count % 2 == 1 ? first[count / 2] : 0.5 * (first[count / 2 - 1] + first[count / 2]);
}

}  // namespace

Exposures choose_exposures(const RgbPlanes& reference) {
  std::vector<double> luminances(static_cast<std::size_t>(reference.r.size()));
  for (Eigen::Index i = 0; i < reference.r.size(); ++i) {
    luminances[static_cast<std::size_t>(i)] = 0.2126 * static_cast<double>(reference.r(i)) +
                                              0.7152 * static_cast<double>(reference.g(i)) +
                                              0.0722 * static_cast<double>(reference.b(i));
  }
  std::sort(luminances.begin(), luminances.end());
  const double* first = luminances.data();
  const double* last = first + luminances.size();
  const double brightest = luminances.back();
  if (!(brightest > 0.0)) return {};
  double middle = median(first, last);
  if (!(middle > 0.0)) middle = median(std::upper_bound(first, last, 0.0), last);
  Exposures exposures{.start = std::log2(nearly_white() / brightest),
                      .stop = std::log2(nearly_white() / middle)};
  exposures.count = std::max(2, static_cast<int>(std::ceil(exposures.stop - exposures.start)));
  return exposures;
}

RgbPlanes expose(const RgbPlanes& radiance, double stops) {
  // The scale is a double: for radiance near the largest float, a float scale would be flushed to zero.
  const double scale = std::exp2(stops) * static_cast<double>(kPreExposure);
  RgbPlanes shown;
  const auto curve = [&](const Plane& from, Plane& to) {
    to.resize(from.rows(), from.cols());
    tbb::parallel_for(Eigen::Index{0}, from.rows(), [&](Eigen::Index row) {
      for (Eigen::Index x = 0; x < from.cols(); ++x)
        to(row, x) = filmic(finite_float(scale * static_cast<double>(from(row, x))));
    });
  };
  curve(radiance.r, shown.r);
  curve(radiance.g, shown.g);
  curve(radiance.b, shown.b);
  return shown;
}

}  // namespace gatelight::renderer::flip

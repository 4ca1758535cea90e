#include "renderer/metrics/flip/filters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gatelight::renderer::flip {
namespace {

using std::numbers::pi;
using Weights = std::vector<double>;

/// A contrast sensitivity filter a sqrt(pi/b) exp(-pi^2 r^2 / b) with r in degrees: table 1 of 2020.
struct Sensitivity {
  double a;
  double b;
};
constexpr Sensitivity kAchromatic{1.0, 0.0047};
constexpr Sensitivity kRedGreen{1.0, 0.0053};
constexpr Sensitivity kBlueYellowWide{34.1, 0.04};
constexpr Sensitivity kBlueYellowNarrow{13.5, 0.025};

/// The width of the feature filters in degrees.
constexpr double kFeatureWidth = 0.082;

/// The weights along one axis. They have the square root of the factor before the exponential, so that the
/// product of two axes has the factor once.
Weights sensitivity_weights(const Sensitivity& s, int radius, double pixels_per_degree) {
  Weights weights;
  for (int i = -radius; i <= radius; ++i) {
    const double degrees = i / pixels_per_degree;
    weights.push_back(std::sqrt(s.a * std::sqrt(pi / s.b)) * std::exp(-pi * pi * degrees * degrees / s.b));
  }
  return weights;
}

double sum(const Weights& weights) {
  double total = 0.0;
  for (const double weight : weights) total += weight;
  return total;
}

Kernel scaled(const Weights& weights, double factor) {
  Kernel kernel;
  for (const double weight : weights) kernel.weights.push_back(static_cast<float>(weight * factor));
  return kernel;
}

Kernel normalized(const Weights& weights) {
  return scaled(weights, 1.0 / sum(weights));
}

/// Scales positive weights to the sum 1 and negative ones to -1.
Kernel balanced(Weights weights) {
  double positive = 0.0;
  double negative = 0.0;
  for (const double weight : weights) (weight > 0.0 ? positive : negative) += std::abs(weight);
  for (double& weight : weights) weight /= weight > 0.0 ? positive : negative;
  return scaled(weights, 1.0);
}

}  // namespace

int Filters::radius() const {
  return std::max(blue_yellow_wide.radius(), gaussian.radius());
}

Filters make_filters(double pixels_per_degree) {
  Filters filters;
  // The radius is three standard deviations of the widest filter.
  const int spatial_radius =
      static_cast<int>(std::ceil(3.0 * std::sqrt(kBlueYellowWide.b / (2.0 * pi * pi)) * pixels_per_degree));
  const auto spatial = [&](const Sensitivity& s) {
    return sensitivity_weights(s, spatial_radius, pixels_per_degree);
  };
  filters.achromatic = normalized(spatial(kAchromatic));
  filters.red_green = normalized(spatial(kRedGreen));
  const Weights wide = spatial(kBlueYellowWide);
  const Weights narrow = spatial(kBlueYellowNarrow);
  const double both = std::hypot(sum(wide), sum(narrow));
  filters.blue_yellow_wide = scaled(wide, 1.0 / both);
  filters.blue_yellow_narrow = scaled(narrow, 1.0 / both);

  const double sigma = 0.5 * kFeatureWidth * pixels_per_degree;
  const int feature_radius = static_cast<int>(std::ceil(3.0 * sigma));
  Weights gaussian, edge, point;
  for (int i = -feature_radius; i <= feature_radius; ++i) {
    const double x = i / sigma;
    gaussian.push_back(std::exp(-0.5 * x * x));
    edge.push_back(-x * gaussian.back());
    point.push_back((x * x - 1.0) * gaussian.back());
  }
  filters.gaussian = normalized(gaussian);
  filters.edge = balanced(edge);
  filters.point = balanced(point);
  return filters;
}

}  // namespace gatelight::renderer::flip

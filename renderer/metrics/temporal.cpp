#include "renderer/metrics/temporal.h"

#include <tbb/parallel_for.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "renderer/image/srgb.h"
#include "renderer/metrics/flip/planes.h"

namespace gatelight::renderer {
namespace {

using Eigen::Index;
using Row = Eigen::Array<double, 1, Eigen::Dynamic>;
using DoublePlane = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr Index kGaussianRadius = static_cast<Index>(3.0 * kTemporalSigma);
using Gaussian = Eigen::Array<double, 2 * kGaussianRadius + 1, 1>;

/// Weights along one axis. The Gaussian is the product of two.
Gaussian gaussian_weights() {
  Gaussian weights;
  for (Index k = -kGaussianRadius; k <= kGaussianRadius; ++k) {
    const double x = static_cast<double>(k) / kTemporalSigma;
    weights[k + kGaussianRadius] = std::exp(-0.5 * x * x);
  }
  return weights / weights.sum();
}

/// Test minus reference on the screen, channel after channel.
std::vector<float> screen_differences(const flip::RgbPlanes& reference, const flip::RgbPlanes& test) {
  const std::array<std::pair<const flip::Plane*, const flip::Plane*>, 3> channels{
      {{&reference.r, &test.r}, {&reference.g, &test.g}, {&reference.b, &test.b}}};
  const Index width = reference.width(), height = reference.height();
  std::vector<float> all(static_cast<std::size_t>(3 * width * height));
  tbb::parallel_for(Index{0}, 3 * height, [&](Index row) {
    const auto& [r, t] = channels[static_cast<std::size_t>(row / height)];
    const Index y = row % height;
    for (Index x = 0; x < width; ++x)
      all[static_cast<std::size_t>(row * width + x)] =
          linear_to_srgb((*t)(y, x)) - linear_to_srgb((*r)(y, x));
  });
  return all;
}

Row smooth_x(const Row& row, const Gaussian& weights) {
  const Index width = row.cols();
  Row padded(width + 2 * kGaussianRadius);
  padded.head(kGaussianRadius).setConstant(row[0]);
  padded.segment(kGaussianRadius, width) = row;
  padded.tail(kGaussianRadius).setConstant(row[width - 1]);
  Row sum = Row::Zero(width);
  for (Index k = 0; k < weights.size(); ++k) sum += weights[k] * padded.segment(k, width);
  return sum;
}

Row smooth_y(const DoublePlane& plane, Index y, const Gaussian& weights) {
  Row sum = Row::Zero(plane.cols());
  for (Index k = 0; k < weights.size(); ++k)
    sum += weights[k] * plane.row(std::clamp(y + k - kGaussianRadius, Index{0}, plane.rows() - 1));
  return sum;
}

}  // namespace

void TemporalMeter::add(const NamedPicture& reference, const NamedPicture& test) {
  const bool is_first = before_.empty();
  require_comparable(reference, test);
  if (!is_first) require_comparable({first_, first_name_}, reference);
  const auto shown = [&](const NamedPicture& named) {
    return flip::read_shown(named, "the temporal deviation", options_.exposure, options_.tonemap);
  };
  std::vector<float> now = screen_differences(shown(reference), shown(test));
  if (is_first) {
    first_ = without_values(reference.picture);
    first_name_ = reference.name;
  } else {
    add_pair(now, static_cast<std::size_t>(reference.picture.width));
  }
  before_ = std::move(now);
}

void TemporalMeter::add_pair(const std::vector<float>& now, std::size_t width) {
  static const Gaussian weights = gaussian_weights();
  const auto columns = static_cast<Index>(width);
  const Index height = static_cast<Index>(now.size()) / 3 / columns;
  DoublePlane change(height, columns);
  DoublePlane along_x(height, columns);
  std::vector<std::array<double, 2>> squares(static_cast<std::size_t>(height));
  for (Index channel = 0; channel < 3; ++channel) {
    tbb::parallel_for(Index{0}, height, [&](Index y) {
      const auto begin = static_cast<std::size_t>((channel * height + y) * columns);
      for (std::size_t x = 0; x < width; ++x)
        change(y, static_cast<Index>(x)) =
            static_cast<double>(now[begin + x]) - static_cast<double>(before_[begin + x]);
      along_x.row(y) = smooth_x(change.row(y), weights);
    });
    tbb::parallel_for(Index{0}, height, [&](Index y) {
      const Row low = smooth_y(along_x, y, weights);
      const Row high = change.row(y) - low;
      squares[static_cast<std::size_t>(y)] = {low.square().sum(), high.square().sum()};
    });
    for (const auto& [low, high] : squares) {
      low_ += low;
      high_ += high;
    }
  }
  values_ += now.size();
}

std::optional<TemporalDeviation> TemporalMeter::deviation() const {
  if (values_ == 0) return std::nullopt;
  const auto count = static_cast<double>(values_);
  return TemporalDeviation{.low = std::sqrt(low_ / count), .high = std::sqrt(high_ / count)};
}

}  // namespace gatelight::renderer

#include "renderer/metrics/ssim.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/image/srgb.h"
#include "renderer/metrics/flip/planes.h"

namespace gatelight::renderer {
namespace {

using Eigen::Index;
using Row = Eigen::Array<double, 1, Eigen::Dynamic>;
using GreyPlane = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Weights = Eigen::Array<double, kSsimWindow, 1>;

constexpr double kSigma = 1.5;
constexpr double kC1 = 0.01 * 0.01;
constexpr double kC2 = 0.03 * 0.03;

/// The rows that one task computes.
constexpr Index kBandRows = 32;

/// Weights along one axis. The window is the product of two.
Weights window_weights() {
  Weights weights;
  for (int i = 0; i < kSsimWindow; ++i) {
    const int from_center = i - kSsimWindow / 2;
    const double x = from_center / kSigma;
    weights[i] = std::exp(-0.5 * x * x);
  }
  return weights / weights.sum();
}

GreyPlane read_grey(const NamedPicture& named, const SsimOptions& options) {
  const flip::RgbPlanes shown = flip::read_shown(named, "SSIM", options.exposure, options.tonemap);
  GreyPlane grey(shown.height(), shown.width());
  tbb::parallel_for(Index{0}, grey.rows(), [&](Index y) {
    for (Index x = 0; x < grey.cols(); ++x) {
      grey(y, x) = 0.299 * static_cast<double>(linear_to_srgb(shown.r(y, x))) +
                   0.587 * static_cast<double>(linear_to_srgb(shown.g(y, x))) +
                   0.114 * static_cast<double>(linear_to_srgb(shown.b(y, x)));
    }
  });
  return grey;
}

/// Weighted means of some rows, filtered along x only. The squared difference replaces the product of both
/// pictures, so that equal pictures give exactly 0.
struct Moments {
  GreyPlane reference, test, reference_square, test_square, difference_square;

  Moments(Index rows, Index columns) {
    for (GreyPlane* plane : {&reference, &test, &reference_square, &test_square, &difference_square}) {
      plane->resize(rows, columns);
    }
  }
};

Row filter_x(const Row& row, const Weights& weights) {
  const Index columns = row.cols() - kSsimWindow + 1;
  Row sum = Row::Zero(columns);
  for (Index k = 0; k < kSsimWindow; ++k) sum += weights[k] * row.segment(k, columns);
  return sum;
}

Row filter_y(const GreyPlane& plane, Index first, const Weights& weights) {
  Row sum = Row::Zero(plane.cols());
  for (Index k = 0; k < kSsimWindow; ++k) sum += weights[k] * plane.row(first + k);
  return sum;
}

/// Sums SSIM over the windows whose upper edges are the rows `begin` to `end`.
void sum_band(const GreyPlane& reference, const GreyPlane& test, Index begin, Index end,
              const Weights& weights, std::vector<double>& sums) {
  const Index rows = end - begin + kSsimWindow - 1;
  Moments moments(rows, reference.cols() - kSsimWindow + 1);
  for (Index i = 0; i < rows; ++i) {
    const Row r = reference.row(begin + i);
    const Row t = test.row(begin + i);
    moments.reference.row(i) = filter_x(r, weights);
    moments.test.row(i) = filter_x(t, weights);
    moments.reference_square.row(i) = filter_x(r.square(), weights);
    moments.test_square.row(i) = filter_x(t.square(), weights);
    moments.difference_square.row(i) = filter_x((t - r).square(), weights);
  }
  for (Index y = begin; y < end; ++y) {
    const Index first = y - begin;
    const Row r = filter_y(moments.reference, first, weights);
    const Row t = filter_y(moments.test, first, weights);
    const Row means = r.square() + t.square();
    const Row variances = (filter_y(moments.reference_square, first, weights) +
                           filter_y(moments.test_square, first, weights) - means)
                              .max(0.0);
    const Row of_means = (t - r).square();
    const Row of_structure = (filter_y(moments.difference_square, first, weights) - of_means).max(0.0);
    // (2 r t + c) / (r^2 + t^2 + c) = 1 - (t - r)^2 / (r^2 + t^2 + c); the same holds for the covariance.
    sums[static_cast<std::size_t>(y)] =
        ((1.0 - of_means / (means + kC1)) * (1.0 - of_structure / (variances + kC2))).sum();
  }
}

}  // namespace

double ssim(const NamedPicture& reference, const NamedPicture& test, const SsimOptions& options) {
  require_comparable(reference, test);
  const GreyPlane r = read_grey(reference, options);
  const GreyPlane t = read_grey(test, options);
  if (!has_ssim(reference.picture)) {
    throw InputError(fmt::format("'{}' has {}x{} pixels; SSIM is defined from {}x{}", reference.name,
                                 reference.picture.width, reference.picture.height, kSsimWindow,
                                 kSsimWindow));
  }
  const Weights weights = window_weights();
  const Index rows = r.rows() - kSsimWindow + 1;
  const Index columns = r.cols() - kSsimWindow + 1;
  std::vector<double> sums(static_cast<std::size_t>(rows));
  tbb::parallel_for(Index{0}, (rows + kBandRows - 1) / kBandRows, [&](Index band) {
    sum_band(r, t, band * kBandRows, std::min((band + 1) * kBandRows, rows), weights, sums);
  });
  double sum = 0.0;
  for (const double of_row : sums) sum += of_row;
  return sum / (static_cast<double>(rows) * static_cast<double>(columns));
}

}  // namespace gatelight::renderer

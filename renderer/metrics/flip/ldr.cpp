#include "renderer/metrics/flip/ldr.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/metrics/flip/color_spaces.h"

namespace gatelight::renderer::flip {
namespace {

using Eigen::Index;

/// The rows that one task computes. The results of the filters along x for these rows and their neighbours
/// fit in the processor's cache.
constexpr Index kBandRows = 32;

// Constants of 2020, table 2.
constexpr float kColorExponent = 0.7f;    // q_c
constexpr float kColorKnee = 0.4f;        // p_c: this fraction of the largest difference ...
constexpr float kColorKneeError = 0.95f;  // p_t: ... maps to this fraction of the error range
constexpr float kFeatureExponent = 0.5f;  // q_f

/// Rows of a picture after the filters along x.
struct FilteredX {
  Index first = 0;  ///< the picture's row that is row 0 here
  Index height = 0;
  Plane y, red_green, blue_yellow_wide, blue_yellow_narrow;  ///< of YCxCz
  Plane gaussian, edge, point;                               ///< of the achromatic channel in [0, 1]

  FilteredX(Index first_row, Index rows, Index width) : first(first_row), height(rows) {
    for (Plane* plane : {&y, &red_green, &blue_yellow_wide, &blue_yellow_narrow, &gaussian, &edge, &point}) {
      plane->resize(rows, width);
    }
  }
};

/// `padded` holds `pad` more pixels on each side.
Row filter_x(const Row& padded, Index pad, const Kernel& kernel) {
  const Index width = padded.cols() - 2 * pad;
  Row sum = Row::Zero(width);
  for (std::size_t k = 0; k < kernel.weights.size(); ++k) {
    sum += kernel.weights[k] * padded.segment(pad - kernel.radius() + static_cast<Index>(k), width);
  }
  return sum;
}

/// Repeats the border pixels beyond the border.
Row pad_row(const Row& row, Index pad) {
  Row padded(row.cols() + 2 * pad);
  padded << Row::Constant(pad, row[0]), row, Row::Constant(pad, row[row.cols() - 1]);
  return padded;
}

FilteredX filter_rows(const RgbPlanes& rgb, Index first, Index last, const Filters& filters) {
  FilteredX out(first, last - first, rgb.width());
  const Index pad = filters.radius();
  for (Index row = first; row < last; ++row) {
    const OpponentRow ycxcz = rgb_to_ycxcz({rgb.r.row(row), rgb.g.row(row), rgb.b.row(row)});
    const Index i = row - first;
    const Row y = pad_row(ycxcz.y, pad);
    const Row red_green = pad_row(ycxcz.red_green, pad);
    const Row blue_yellow = pad_row(ycxcz.blue_yellow, pad);
    out.y.row(i) = filter_x(y, pad, filters.achromatic);
    out.red_green.row(i) = filter_x(red_green, pad, filters.red_green);
    out.blue_yellow_wide.row(i) = filter_x(blue_yellow, pad, filters.blue_yellow_wide);
    out.blue_yellow_narrow.row(i) = filter_x(blue_yellow, pad, filters.blue_yellow_narrow);
    const Row grey = (y + 16.0f) / 116.0f;
    out.gaussian.row(i) = filter_x(grey, pad, filters.gaussian);
    out.edge.row(i) = filter_x(grey, pad, filters.edge);
    out.point.row(i) = filter_x(grey, pad, filters.point);
  }
  return out;
}

/// Computes one row of a picture of this height.
Row filter_y(const FilteredX& rows, const Plane& plane, Index row, Index height, const Kernel& kernel) {
  Row sum = Row::Zero(plane.cols());
  for (std::size_t k = 0; k < kernel.weights.size(); ++k) {
    const Index from = std::clamp<Index>(row - kernel.radius() + static_cast<Index>(k), 0, height - 1);
    sum += kernel.weights[k] * plane.row(from - rows.first);
  }
  return sum;
}

OpponentRow perceived_color(const FilteredX& rows, Index row, Index height, const Filters& filters) {
  const OpponentRow ycxcz{
      filter_y(rows, rows.y, row, height, filters.achromatic),
      filter_y(rows, rows.red_green, row, height, filters.red_green),
      filter_y(rows, rows.blue_yellow_wide, row, height, filters.blue_yellow_wide) +
          filter_y(rows, rows.blue_yellow_narrow, row, height, filters.blue_yellow_narrow)};
  return rgb_to_hunt_lab(ycxcz_to_unit_rgb(ycxcz));
}

/// The gradient length of edges or points. `along` is the kernel of the derivative, `plane_x` its result
/// along x.
Row feature(const FilteredX& rows, const Plane& plane_x, const Kernel& along, Index row, Index height,
            const Filters& filters) {
  const Row dx = filter_y(rows, plane_x, row, height, filters.gaussian);
  const Row dy = filter_y(rows, rows.gaussian, row, height, along);
  return (dx.square() + dy.square()).sqrt();
}

/// The largest distance between two colours of a screen, pure green and pure blue, to the power of q_c.
float largest_color_difference() {
  const Row zero = Row::Zero(1);
  const Row one = Row::Ones(1);
  return std::pow(hyab_distance(rgb_to_hunt_lab({zero, one, zero}), rgb_to_hunt_lab({zero, zero, one}))[0],
                  kColorExponent);
}

/// Differences up to the knee get most of the error range (2020, eq. 8).
Row color_error(const OpponentRow& reference, const OpponentRow& test) {
  static const float largest = largest_color_difference();
  const float knee = kColorKnee * largest;
  const Row difference = hyab_distance(reference, test).pow(kColorExponent);
  return (difference < knee)
      .select(difference * (kColorKneeError / knee),
              kColorKneeError + (difference - knee) * ((1.0f - kColorKneeError) / (largest - knee)));
}

Row feature_error(const FilteredX& reference, const FilteredX& test, Index row, Index height,
                  const Filters& filters) {
  const Row edge = (feature(reference, reference.edge, filters.edge, row, height, filters) -
                    feature(test, test.edge, filters.edge, row, height, filters))
                       .abs();
  const Row point = (feature(reference, reference.point, filters.point, row, height, filters) -
                     feature(test, test.point, filters.point, row, height, filters))
                        .abs();
  constexpr float kNormalization = 1.0f / std::numbers::sqrt2_v<float>;
  return (kNormalization * edge.max(point)).min(1.0f).pow(kFeatureExponent);
}

}  // namespace

Plane ldr_errors(const RgbPlanes& reference, const RgbPlanes& test, const Filters& filters) {
  const Index height = reference.height();
  Plane errors(height, reference.width());
  const Index bands = (height + kBandRows - 1) / kBandRows;
  tbb::parallel_for(Index{0}, bands, [&](Index band) {
    const Index begin = band * kBandRows;
    const Index end = std::min(begin + kBandRows, height);
    const Index first = std::max<Index>(begin - filters.radius(), 0);
    const Index last = std::min<Index>(end + filters.radius(), height);
    const FilteredX r = filter_rows(reference, first, last, filters);
    const FilteredX t = filter_rows(test, first, last, filters);
    for (Index row = begin; row < end; ++row) {
      const Row color =
          color_error(perceived_color(r, row, height, filters), perceived_color(t, row, height, filters));
      const Row power = 1.0f - feature_error(r, t, row, height, filters);
      errors.row(row) = color.pow(power).max(0.0f).min(1.0f);
    }
  });
  return errors;
}

}  // namespace gatelight::renderer::flip

#include "renderer/metrics/flip.h"

#include <fmt/format.h>
#include <tbb/parallel_sort.h>

#include "base/errors.h"
#include "renderer/image/srgb.h"
#include "renderer/metrics/flip/color_map.h"
#include "renderer/metrics/flip/exposures.h"
#include "renderer/metrics/flip/filters.h"
#include "renderer/metrics/flip/ldr.h"
#include "renderer/metrics/flip/planes.h"

namespace gatelight::renderer {
namespace {

using flip::Plane;
using flip::RgbPlanes;

constexpr const char* kMeasure = "FLIP";

flip::Filters make_checked_filters(const FlipOptions& options) {
  const double ppd = options.pixels_per_degree;
  if (!(ppd >= kMinPixelsPerDegree && ppd <= kMaxPixelsPerDegree)) {
    throw BadOption({"pixels-per-degree", fmt::format("{}", ppd), "",
                     fmt::format("{} to {}", kMinPixelsPerDegree, kMaxPixelsPerDegree)});
  }
  return flip::make_filters(ppd);
}

/// The error at which the running sum of the sorted errors exceeds `part` of their total `sum`.
double weighted_quantile(const std::vector<float>& sorted, double part, double sum) {
  double running = 0.0;
  for (const float error : sorted) {
    running += static_cast<double>(error);
    if (running > part * sum) return static_cast<double>(error);
  }
  return 0.0;
}

FlipResult make_result(const Plane& errors) {
  FlipResult result{.width = static_cast<int>(errors.cols()), .height = static_cast<int>(errors.rows())};
  result.errors.assign(errors.data(), errors.data() + errors.size());
  result.summary = summarize(result.errors);
  return result;
}

}  // namespace

FlipSummary summarize(std::span<const float> errors) {
  std::vector<float> sorted(errors.begin(), errors.end());
  tbb::parallel_sort(sorted.begin(), sorted.end());
  double sum = 0.0;
  for (const float error : sorted) sum += static_cast<double>(error);
  return {.mean = sum / static_cast<double>(sorted.size()),
          .weighted_median = weighted_quantile(sorted, 0.5, sum),
          .first_quartile = weighted_quantile(sorted, 0.25, sum),
          .third_quartile = weighted_quantile(sorted, 0.75, sum),
          .min = static_cast<double>(sorted.front()),
          .max = static_cast<double>(sorted.back())};
}

FlipResult ldr_flip(const NamedPicture& reference, const NamedPicture& test, const FlipOptions& options) {
  require_comparable(reference, test);
  const flip::Filters filters = make_checked_filters(options);
  const RgbPlanes r = flip::read_shown(reference, kMeasure, options.exposure, options.tonemap);
  const RgbPlanes t = flip::read_shown(test, kMeasure, options.exposure, options.tonemap);
  return make_result(flip::ldr_errors(r, t, filters));
}

FlipResult hdr_flip(const NamedPicture& reference, const NamedPicture& test, const FlipOptions& options) {
  return *hdr_flip(reference, test, options, [](double) { return true; });
}

std::optional<FlipResult> hdr_flip(const NamedPicture& reference, const NamedPicture& test,
                                   const FlipOptions& options, const std::function<bool(double)>& go_on) {
  require_comparable(reference, test);
  const flip::Filters filters = make_checked_filters(options);
  const RgbPlanes r = flip::read_planes(reference, kMeasure);
  const RgbPlanes t = flip::read_planes(test, kMeasure);
  const flip::Exposures exposures = flip::choose_exposures(r);
  Plane errors = Plane::Zero(r.height(), r.width());
  for (int i = 0; i < exposures.count; ++i) {
    if (!go_on(static_cast<double>(i) / exposures.count)) return std::nullopt;
    const double stops = exposures.at(i);
    errors = errors.max(flip::ldr_errors(flip::expose(r, stops), flip::expose(t, stops), filters));
  }
  FlipResult result = make_result(errors);
  result.start_exposure = exposures.start;
  result.stop_exposure = exposures.stop;
  result.exposures = exposures.count;
  return result;
}

Picture flip_map(const FlipResult& result) {
  Picture map{.width = result.width, .height = result.height};
  Layer layer{.channels = {"R", "G", "B"}};
  layer.values.reserve(3 * result.errors.size());
  for (const float error : result.errors) {
    for (const float display : flip::magma(error)) layer.values.push_back(srgb_to_linear(display));
  }
  map.layers.push_back(std::move(layer));
  return map;
}

}  // namespace gatelight::renderer

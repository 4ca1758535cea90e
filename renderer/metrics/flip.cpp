#include "renderer/metrics/flip.h"

#include <fmt/format.h>

#include "renderer/image/srgb.h"
#include "renderer/machine/errors.h"
#include "renderer/metrics/flip/color_map.h"
#include "renderer/metrics/flip/exposures.h"
#include "renderer/metrics/flip/filters.h"
#include "renderer/metrics/flip/ldr.h"
#include "renderer/metrics/flip/shown.h"
#include "renderer/metrics/flip/summary.h"

namespace gatelight::renderer {
namespace {

using flip::Plane;
using flip::RgbPlanes;

constexpr const char* kMeasure = "FLIP";

flip::Filters make_checked_filters(const FlipOptions& options) {
  const double ppd = options.pixels_per_degree;
  if (!(ppd >= kMinPixelsPerDegree && ppd <= kMaxPixelsPerDegree)) {
    throw BadOption(fmt::format("{} pixels per degree: expected {} to {}", ppd, kMinPixelsPerDegree,
                                kMaxPixelsPerDegree));
  }
  return flip::make_filters(ppd);
}

FlipResult make_result(const Plane& errors) {
  FlipResult result{.width = static_cast<int>(errors.cols()), .height = static_cast<int>(errors.rows())};
  result.errors.assign(errors.data(), errors.data() + errors.size());
  result.summary = flip::summarize(result.errors);
  return result;
}

}  // namespace

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

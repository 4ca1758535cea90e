#include "renderer/flip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/beauty.h"
#include "renderer/errors.h"
#include "renderer/flip/color_map.h"
#include "renderer/flip/exposures.h"
#include "renderer/flip/filters.h"
#include "renderer/flip/ldr.h"
#include "renderer/flip/summary.h"
#include "renderer/srgb.h"

namespace gatelight::renderer {
namespace {

using flip::Plane;
using flip::RgbPlanes;

/// Negative values, which no screen shows, become 0.
RgbPlanes read_planes(const NamedPicture& named) {
  const Beauty beauty(named);
  const std::size_t pixels = pixel_count(named.picture);
  if (pixels == 0) throw CompareError(fmt::format("'{}' has no pixels", named.name));
  RgbPlanes planes;
  for (Plane* plane : {&planes.r, &planes.g, &planes.b}) {
    plane->resize(named.picture.height, named.picture.width);
  }
  std::size_t not_finite = 0;
  for (std::size_t p = 0; p < pixels; ++p) {
    const Rgb color = beauty.at(p);
    not_finite += finite(color) ? 0 : 1;
    planes.r.data()[p] = static_cast<float>(std::max(color[0], 0.0));
    planes.g.data()[p] = static_cast<float>(std::max(color[1], 0.0));
    planes.b.data()[p] = static_cast<float>(std::max(color[2], 0.0));
  }
  if (not_finite > 0) {
    throw CompareError(fmt::format("'{}' has {} pixels that are not finite; FLIP is defined for finite ones",
                                   named.name, not_finite));
  }
  return planes;
}

void show(RgbPlanes& planes, const FlipOptions& options) {
  const float scale = exposure_scale(options.exposure);
  for (Plane* plane : {&planes.r, &planes.g, &planes.b}) {
    *plane = plane->unaryExpr([&](float x) {
      const float exposed = x * scale;
      return options.tonemap == Tonemap::filmic ? filmic(exposed) : std::min(exposed, 1.0f);
    });
  }
}

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
  require_same_size(reference, test);
  const flip::Filters filters = make_checked_filters(options);
  RgbPlanes r = read_planes(reference);
  RgbPlanes t = read_planes(test);
  show(r, options);
  show(t, options);
  return make_result(flip::ldr_errors(r, t, filters));
}

FlipResult hdr_flip(const NamedPicture& reference, const NamedPicture& test, const FlipOptions& options) {
  require_same_size(reference, test);
  const flip::Filters filters = make_checked_filters(options);
  const RgbPlanes r = read_planes(reference);
  const RgbPlanes t = read_planes(test);
  const flip::Exposures exposures = flip::choose_exposures(r);
  Plane errors = Plane::Zero(r.height(), r.width());
  for (int i = 0; i < exposures.count; ++i) {
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

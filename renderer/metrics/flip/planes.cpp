#include "renderer/metrics/flip/planes.h"

#include <fmt/format.h>

#include <algorithm>

namespace gatelight::renderer::flip {

RgbPlanes read_planes(const NamedPicture& named, const char* measure) {
  const Beauty beauty(named);
  const std::size_t pixels = pixel_count(named.picture);
  if (pixels == 0) throw InputError(fmt::format("'{}' has no pixels", named.name));
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
    throw InputError(fmt::format("'{}' has {} pixels that are not finite; {} is defined for finite ones",
                                 named.name, not_finite, measure));
  }
  return planes;
}

RgbPlanes read_shown(const NamedPicture& named, const char* measure, float exposure, Tonemap tonemap) {
  RgbPlanes planes = read_planes(named, measure);
  const float scale = exposure_scale(exposure);
  for (Eigen::Index i = 0; i < planes.r.size(); ++i) {
    float& r = planes.r.data()[i];
    float& g = planes.g.data()[i];
    float& b = planes.b.data()[i];
    const gatelight::Color shown = tonemapped(gatelight::Color(r, g, b) * scale, tonemap);
    r = shown[0];
    g = shown[1];
    b = shown[2];
  }
  return planes;
}

}  // namespace gatelight::renderer::flip

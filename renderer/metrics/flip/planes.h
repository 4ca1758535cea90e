#pragma once
// Pictures as FLIP uses them: one plane of floats for each channel.

#include <Eigen/Core>

#include "renderer/image/tonemap.h"
#include "renderer/metrics/beauty.h"

namespace gatelight::renderer::flip {

using Row = Eigen::Array<float, 1, Eigen::Dynamic>;
using Plane = Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Planes of linear light.
struct RgbPlanes {
  Plane r, g, b;

  Eigen::Index width() const { return r.cols(); }
  Eigen::Index height() const { return r.rows(); }
};

/// Reads radiance. Negative values, which no screen shows, become 0. Throws InputError for a picture
/// without a beauty layer, without pixels or with values that are not finite. `measure` is the metric's name
/// for the message.
RgbPlanes read_planes(const NamedPicture& named, const char* measure);

/// Reads linear light: radiance times 2^exposure, through the tone curve, clamped to [0, 1]. Throws what
/// read_planes() throws.
RgbPlanes read_shown(const NamedPicture& named, const char* measure, float exposure, Tonemap tonemap);

}  // namespace gatelight::renderer::flip

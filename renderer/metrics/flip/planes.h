#pragma once
// Pictures as FLIP uses them: one plane of floats for each channel.

#include <Eigen/Core>

namespace gatelight::renderer::flip {

using Row = Eigen::Array<float, 1, Eigen::Dynamic>;
using Plane = Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Planes of linear light.
struct RgbPlanes {
  Plane r, g, b;

  Eigen::Index width() const { return r.cols(); }
  Eigen::Index height() const { return r.rows(); }
};

}  // namespace gatelight::renderer::flip

#include "renderer/film/framing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gatelight::renderer {
namespace {

using Eigen::Vector3d;

/// The two planes through the eye that just enclose all points, one on each side of an axis. `slope` is the
/// tangent of each plane's angle to the view; `most` and `least` are the offsets of the planes.
struct Wedge {
  explicit Wedge(double slope_in) : slope(slope_in) {}

  /// `along` is the coordinate on the axis, `towards` that towards the eye.
  void add(double along, double towards) {
    most = std::max(most, along + slope * towards);
    least = std::max(least, -along + slope * towards);
  }
  double center() const { return 0.5 * (most - least); }
  double distance() const { return 0.5 * (most + least) / slope; }

  double slope;
  double most = -std::numeric_limits<double>::infinity();
  double least = -std::numeric_limits<double>::infinity();
};

}  // namespace

scene::Camera frame_scene(const scene::Scene& scene, float vertical_fov, float aspect) {
  constexpr double kFilled = 0.9;
  const Vector3d back = Vector3d(0.7, 0.45, 1.0).normalized();
  const Vector3d right = Vector3d::UnitY().cross(back).normalized();
  const Vector3d up = back.cross(right);
  scene::Camera camera;
  camera.name = "auto";
  camera.vertical_fov = vertical_fov;
  camera.transform.linear() << right.cast<float>(), up.cast<float>(), back.cast<float>();

  // Relative to the middle, so that scenes far away keep their digits.
  const Vector3d middle =
      scene.bounds.isEmpty() ? Vector3d(Vector3d::Zero()) : scene.bounds.center().cast<double>();
  const double slope = kFilled * std::tan(0.5 * static_cast<double>(vertical_fov));
  Wedge across(slope * static_cast<double>(aspect)), upwards(slope);
  for (const scene::Instance& instance : scene.instances) {
    const std::size_t triangles = scene.mesh_of(instance).triangles.size();
    for (std::size_t t = 0; t < triangles; ++t) {
      for (const Vec3& corner : scene::world_triangle(scene, instance, static_cast<std::uint32_t>(t))) {
        const Vector3d p = corner.cast<double>() - middle;
        across.add(p.dot(right), p.dot(back));
        upwards.add(p.dot(up), p.dot(back));
      }
    }
  }
  Vector3d eye = Vector3d::Zero();
  if (across.most > -std::numeric_limits<double>::infinity()) {
    // A single point has no size.
    const double least = 1e-6 * middle.norm() + 1e-30;
    const double distance = std::max({across.distance(), upwards.distance(), least});
    eye = middle + right * across.center() + up * upwards.center() + back * distance;
  }
  camera.transform.translation() = eye.cast<float>();
  return camera;
}

}  // namespace gatelight::renderer

#include "renderer/film/framing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

namespace gatelight::renderer {
namespace {

using Eigen::Vector3d;

/// A point: its place on an axis of the picture, and towards the eye.
struct Place {
  double along, towards;
};

/// The two planes through the eye that just enclose all points, one on each side of an axis. `slope` is the
/// tangent of each plane's angle to the view; `most` and `least` are the offsets of the planes.
struct Wedge {
  explicit Wedge(double slope_in) : slope(slope_in) {}

  void add(const Place& p) {
    most = std::max(most, p.along + slope * p.towards);
    least = std::max(least, -p.along + slope * p.towards);
  }
  double center() const { return 0.5 * (most - least); }
  double distance() const { return 0.5 * (most + least) / slope; }

  double slope;
  double most = -std::numeric_limits<double>::infinity();
  double least = -std::numeric_limits<double>::infinity();
};

/// The place on an axis from which an eye at this distance sees points as far on the one side as on the
/// other, starting with an estimate. each_place(visit) calls visit(place) for all points.
template <class EachPlace>
double centred(double center, double distance, const EachPlace& each_place) {
  constexpr int kRounds = 16;  // two or three are enough, but for points very near
  for (int round = 0; round < kRounds; ++round) {
    Place first{}, last{};
    double least = std::numeric_limits<double>::infinity(), most = -least;
    each_place([&](const Place& p) {
      const double slope = (p.along - center) / (distance - p.towards);
      if (slope < least) std::tie(least, first) = std::pair(slope, p);
      if (slope > most) std::tie(most, last) = std::pair(slope, p);
    });
    const double before = center;
    const double to_first = distance - first.towards, to_last = distance - last.towards;
    center = (first.along * to_last + last.along * to_first) / (to_first + to_last);
    if (!(std::abs(center - before) > 1e-6 * distance)) break;
  }
  return center;
}

/// The bounds of nearly all triangles, where the rest is so far or so wide that they would be small beside
/// it: a town on its ground. Otherwise infinite.
Box content_of(const scene::Scene& scene) {
  constexpr double kRest = 0.025;            // share of the triangles, on each side of each axis
  constexpr float kSmall = 0.1f;             // of the whole
  constexpr std::size_t kCompared = 100000;  // triangles
  const std::size_t step = scene::count_triangles(scene) / kCompared + 1;
  std::array<std::vector<float>, 3> places;
  for (const scene::Instance& instance : scene.instances) {
    const std::size_t triangles = scene.mesh_of(instance).triangles.size();
    for (std::size_t t = 0; t < triangles; t += step) {
      for (const Vec3& corner : scene::world_triangle(scene, instance, static_cast<std::uint32_t>(t))) {
        for (std::size_t k = 0; k < 3; ++k) places[k].push_back(corner[static_cast<Eigen::Index>(k)]);
      }
    }
  }
  const Box all(Vec3::Constant(-kInfinity), Vec3::Constant(kInfinity));
  if (places[0].empty()) return all;
  Box content;
  for (const double share : {kRest, 1.0 - kRest}) {
    Vec3 p;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at =
          places[k].begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(places[k].size()));
      std::nth_element(places[k].begin(), at, places[k].end());
      p[static_cast<Eigen::Index>(k)] = *at;
    }
    content.extend(p);
  }
  const Vec3 margin = Vec3::Constant(0.1f * content.sizes().maxCoeff());
  if (content.sizes().maxCoeff() > kSmall * scene.bounds.sizes().maxCoeff()) return all;
  return Box(content.min() - margin, content.max() + margin);
}

}  // namespace

scene::Camera frame_scene(const scene::Scene& scene, float vertical_fov, float aspect) {
  constexpr double kFilled = 0.9;
  const double front = static_cast<double>(scene.front);
  const Vector3d back = Vector3d(0.7 * front, 0.45, front).normalized();
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
  const Box content = content_of(scene);
  const auto each_place = [&](const Vector3d& axis, const auto& visit) {
    for (const scene::Instance& instance : scene.instances) {
      const std::size_t triangles = scene.mesh_of(instance).triangles.size();
      for (std::size_t t = 0; t < triangles; ++t) {
        for (const Vec3& corner : scene::world_triangle(scene, instance, static_cast<std::uint32_t>(t))) {
          const Vec3 near = corner.cwiseMax(content.min()).cwiseMin(content.max());
          const Vector3d p = near.cast<double>() - middle;
          visit(Place{p.dot(axis), p.dot(back)});
        }
      }
    }
  };
  Wedge across(slope * static_cast<double>(aspect)), upwards(slope);
  each_place(right, [&](const Place& p) { across.add(p); });
  each_place(up, [&](const Place& p) { upwards.add(p); });
  Vector3d eye = Vector3d::Zero();
  if (across.most > -std::numeric_limits<double>::infinity()) {
    // A single point has no size.
    const double least = 1e-6 * middle.norm() + 1e-30;
    const double distance = std::max({across.distance(), upwards.distance(), least});
    // An axis that does not set the distance has room on both sides.
    const auto center = [&](const Wedge& wedge, const Vector3d& axis) {
      if (wedge.distance() == distance) return wedge.center();
      return centred(wedge.center(), distance, [&](const auto& visit) { each_place(axis, visit); });
    };
    eye = middle + right * center(across, right) + up * center(upwards, up) + back * distance;
  }
  camera.transform.translation() = eye.cast<float>();
  return camera;
}

}  // namespace gatelight::renderer

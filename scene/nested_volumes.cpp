#include "scene/nested_volumes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <tuple>
#include <utility>

namespace gatelight::scene {
namespace {

/// A placed mesh with some surface that has an inside.
struct Body {
  std::vector<std::uint32_t> instances;  ///< all of the placement
  std::vector<std::uint32_t> bounding;   ///< those with an inside
  Box bounds;                            ///< of the latter
  double volume = 0.0;                   ///< cubic metres
};

std::vector<Body> find_bodies(const Scene& scene) {
  std::vector<Body> bodies;
  std::vector<Box> boxes(scene.meshes.size());
  for (std::uint32_t first = 0, end = 0; first < scene.instances.size(); first = end) {
    Body body;
    const int placement = scene.instances[first].placement;
    for (end = first; end < scene.instances.size() && scene.instances[end].placement == placement; ++end) {
      const Instance& instance = scene.instances[end];
      body.instances.push_back(end);
      if (placement < 0 || !scene.material_of(instance).has_volume()) continue;
      body.bounding.push_back(end);
      Box& box = boxes[static_cast<std::size_t>(instance.mesh)];
      if (box.isEmpty()) {
        for (const Vec3& p : scene.mesh_of(instance).positions) box.extend(p);
      }
      for (int corner = 0; corner < 8; ++corner)
        body.bounds.extend(instance.transform * box.corner(static_cast<Box::CornerType>(corner)));
    }
    if (!body.bounding.empty()) bodies.push_back(std::move(body));
  }
  return bodies;
}

/// Leaves the bodies whose bounding boxes touch another's.
void keep_those_that_touch(std::vector<Body>& bodies) {
  std::sort(bodies.begin(), bodies.end(),
            [](const Body& a, const Body& b) { return a.bounds.min().x() < b.bounds.min().x(); });
  std::vector<char> touches(bodies.size(), 0);
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    const float end = bodies[a].bounds.max().x();
    for (std::size_t b = a + 1; b < bodies.size() && bodies[b].bounds.min().x() <= end; ++b) {
      if (bodies[a].bounds.intersects(bodies[b].bounds)) touches[a] = touches[b] = 1;
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (touches[i]) std::swap(bodies[kept++], bodies[i]);
  }
  bodies.resize(kept);
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;
using Place = std::array<long long, 3>;

/// Of the diagonal of what surfaces enclose.
constexpr double kSamePlace = 1e-6;

/// The volume that surfaces of one placement enclose; 0 where they have a hole, or their front faces look
/// inwards. Vertices at the same place, up to rounding, are one: meshes are cut along the borders of their
/// textures.
double enclosed_volume(const Scene& scene, std::span<const std::uint32_t> instances) {
  std::vector<std::array<Vec3, 3>> triangles;
  std::vector<Place> places;
  Box bounds;
  for (const std::uint32_t index : instances) {
    const Instance& instance = scene.instances[index];
    const auto count = static_cast<std::uint32_t>(scene.mesh_of(instance).triangles.size());
    for (std::uint32_t t = 0; t < count; ++t) {
      std::array<Vec3, 3> corners = world_triangle(scene, instance, t);
      if (instance.mirrors) std::swap(corners[1], corners[2]);
      for (const Vec3& p : corners) bounds.extend(p);
      triangles.push_back(corners);
    }
  }
  if (triangles.empty()) return 0.0;
  const Eigen::Vector3d center = bounds.center().cast<double>();
  const double step = kSamePlace * bounds.diagonal().cast<double>().norm();
  const auto place_of = [&](const Vec3& p) {
    const Eigen::Vector3d steps = (p.cast<double>() - center) / step;
    return Place{std::llround(steps.x()), std::llround(steps.y()), std::llround(steps.z())};
  };
  for (const std::array<Vec3, 3>& corners : triangles) {
    for (const Vec3& p : corners) places.push_back(place_of(p));
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  const auto number = [&](const Vec3& p) {
    return static_cast<std::uint32_t>(std::lower_bound(places.begin(), places.end(), place_of(p)) -
                                      places.begin());
  };
  std::vector<Edge> edges, reversed;
  double six_volumes = 0.0;
  for (const std::array<Vec3, 3>& corners : triangles) {
    std::array<std::uint32_t, 3> numbers;
    std::array<Eigen::Vector3d, 3> from_center;
    for (std::size_t k = 0; k < 3; ++k) {
      numbers[k] = number(corners[k]);
      from_center[k] = corners[k].cast<double>() - center;
    }
    six_volumes += from_center[0].dot(from_center[1].cross(from_center[2]));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = numbers[k], b = numbers[(k + 1) % 3];
      if (a == b) continue;
      edges.emplace_back(a, b);
      reversed.emplace_back(b, a);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::sort(reversed.begin(), reversed.end());
  return edges == reversed ? std::max(0.0, six_volumes / 6.0) : 0.0;
}

/// Asks for the volumes of placements that share their meshes once.
class EnclosedVolumes {
 public:
  explicit EnclosedVolumes(const Scene& scene) : scene_(scene) {}

  double operator()(std::span<const std::uint32_t> instances) {
    std::vector<int> meshes;
    bool shared = true;
    for (const std::uint32_t i : instances) {
      meshes.push_back(scene_.instances[i].mesh);
      shared = shared && !scene_.instances[i].baked;
    }
    if (!shared) return enclosed_volume(scene_, instances);
    const double scale =
        std::abs(scene_.instances[instances.front()].transform.linear().cast<double>().determinant());
    const auto [known, is_new] = known_.try_emplace(meshes, 0.0);
    if (is_new) known->second = enclosed_volume(scene_, instances) / scale;
    return known->second * scale;
  }

 private:
  const Scene& scene_;
  std::map<std::vector<int>, double> known_;  ///< by meshes, before they are placed
};

}  // namespace

NestedVolumes find_nested_volumes(const Scene& scene) {
  std::vector<Body> bodies = find_bodies(scene);
  keep_those_that_touch(bodies);
  EnclosedVolumes enclosed(scene);
  for (Body& body : bodies) {
    body.volume = enclosed(body.bounding);
    if (body.volume == 0.0 && body.bounding.size() < body.instances.size())
      body.volume = enclosed(body.instances);
  }
  std::erase_if(bodies, [](const Body& body) { return !(body.volume > 0.0); });
  keep_those_that_touch(bodies);
  const auto strength = [&](const Body& body) {
    const Instance& instance = scene.instances[body.bounding.front()];
    return std::tuple(-instance.dielectric_priority, body.volume, instance.placement);
  };
  std::sort(bodies.begin(), bodies.end(),
            [&](const Body& a, const Body& b) { return strength(a) < strength(b); });
  NestedVolumes nested;
  if (bodies.empty()) return nested;
  nested.of_instance.assign(scene.instances.size(), kNoVolume);
  for (const Body& body : bodies) {
    for (const std::uint32_t instance : body.bounding)
      nested.of_instance[instance] = static_cast<std::uint32_t>(nested.instances.size());
    nested.instances.push_back(body.bounding.front());
  }
  return nested;
}

}  // namespace gatelight::scene

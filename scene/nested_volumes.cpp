#include "scene/nested_volumes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

namespace gatelight::scene {
namespace {

using Indices = std::vector<std::uint32_t>;

/// The surfaces with an inside, of one material, of one placed mesh; or several materials of it that close
/// together.
struct GlassBody {
  Indices instances;
  Indices closing;      ///< opaque surfaces that close it
  Box bounds;           ///< a little larger than the body: instances are placed by rounded transforms
  double volume = 0.0;  ///< cubic metres

  int placement(const Scene& scene) const { return scene.instances[instances.front()].placement; }
};

/// Whether rays always hit surfaces of the material, so that they can bound a volume.
bool can_close(const Material& m) {
  return m.alpha_mode == AlphaMode::opaque && !m.culled;
}

/// Bodies at most this far from each other touch, in shares of their coordinates: two offsets of rays, which
/// would skip a surface behind them.
constexpr float kTouching = 32.0f * 0x1p-23f;

/// The vertices of a mesh, in all states of an open shutter.
Box bounds_in_mesh(const Scene& scene, int mesh) {
  Box box;
  const auto m = static_cast<std::size_t>(mesh);
  for (const Vec3& p : scene.meshes[m].positions) box.extend(p);
  if (!scene.shutter.instances) return box;
  for (const DeformedVertices& state : scene.shutter.vertices[m]) {
    for (const Vec3& p : state.positions) box.extend(p);
  }
  return box;
}

/// Extends `bounds` by an instance, whose mesh is in the box, in all states of an open shutter.
void extend_by_placements(const Scene& scene, std::size_t instance, const Box& box, Box& bounds) {
  const auto extend = [&](const Affine& transform) {
    for (int corner = 0; corner < 8; ++corner)
      bounds.extend(transform * box.corner(static_cast<Box::CornerType>(corner)));
  };
  extend(scene.instances[instance].transform);
  if (!scene.shutter.instances) return;
  for (const Affine& transform : scene.shutter.transforms[instance]) extend(transform);
}

/// `wanted(instance, its material)` leaves others out.
template <class Wanted>
std::vector<GlassBody> find_bodies(const Scene& scene, const Wanted& wanted) {
  std::vector<GlassBody> bodies;
  std::map<std::pair<int, int>, std::size_t> numbers;  // by placement and material
  std::vector<Box> boxes(scene.meshes.size());
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.mesh_of(instance);
    const Material& material = scene.material_of(instance);
    if (instance.hidden || mesh.triangles.empty() || !material.has_volume() || !can_close(material) ||
        !wanted(instance, material))
      continue;
    // Each instance of a scene that is made in code is placed by itself.
    const int placement = instance.placement < 0 ? -1 - static_cast<int>(i) : instance.placement;
    const auto [number, is_new] = numbers.try_emplace({placement, mesh.material}, bodies.size());
    if (is_new) bodies.emplace_back();
    GlassBody& body = bodies[number->second];
    body.instances.push_back(i);
    Box& box = boxes[static_cast<std::size_t>(instance.mesh)];
    if (box.isEmpty()) box = bounds_in_mesh(scene, instance.mesh);
    extend_by_placements(scene, i, box, body.bounds);
  }
  for (GlassBody& body : bodies) {
    const float largest =
        std::max(body.bounds.min().cwiseAbs().maxCoeff(), body.bounds.max().cwiseAbs().maxCoeff());
    const Vec3 margin = Vec3::Constant(kTouching * largest);
    body.bounds = Box(body.bounds.min() - margin, body.bounds.max() + margin);
  }
  return bodies;
}

/// Keeps the bodies whose bounding boxes touch another's. They are swept along the axis on which they are
/// spread most. With very many bodies it may keep more of them, which costs their paths only a little time.
void keep_those_that_touch(std::vector<GlassBody>& bodies) {
  constexpr std::size_t kMaxTests = 20'000'000;
  Box all;
  for (const GlassBody& body : bodies) all.extend(body.bounds);
  Eigen::Index axis = 0;
  if (!all.isEmpty()) all.sizes().maxCoeff(&axis);
  std::stable_sort(bodies.begin(), bodies.end(), [axis](const GlassBody& a, const GlassBody& b) {
    return a.bounds.min()[axis] < b.bounds.min()[axis];
  });
  std::vector<char> touches(bodies.size(), 0);
  std::size_t tests = 0;
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    const float end = bodies[a].bounds.max()[axis];
    for (std::size_t b = a + 1; b < bodies.size() && bodies[b].bounds.min()[axis] <= end; ++b) {
      if (++tests > kMaxTests) return;
      if (bodies[a].bounds.intersects(bodies[b].bounds)) touches[a] = touches[b] = 1;
    }
  }
  std::vector<GlassBody> kept;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (touches[i]) kept.push_back(std::move(bodies[i]));
  }
  bodies = std::move(kept);
}

/// The triangles of some instances, with vertices of their own.
struct Surfaces {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Numbers points, with the same number for points at the same place. Meshes are cut along the borders of
/// their textures, and the two sides of a cut need not be rounded alike. With a `step`, points at most half a
/// step from each other count as the same, and those more than two steps from each other do not.
Indices weld(const std::vector<Eigen::Vector3d>& points, double step) {
  Indices parent(points.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  using Place = std::array<double, 3>;
  std::vector<std::pair<Place, std::uint32_t>> places(points.size());
  // Neighbours that one grid separates are in one cell of another.
  const int grids = step > 0.0 ? 8 : 1;
  for (int grid = 0; grid < grids; ++grid) {
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      Place& place = places[i].first;
      places[i].second = i;
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = points[i][static_cast<Eigen::Index>(k)];
        place[k] = step > 0.0 ? std::floor(x / step + ((grid >> k & 1) != 0 ? 0.5 : 0.0)) : x + 0.0;
      }
    }
    std::sort(places.begin(), places.end());
    for (std::size_t i = 1; i < places.size(); ++i) {
      if (places[i].first == places[i - 1].first) parent[root(places[i].second)] = root(places[i - 1].second);
    }
  }
  for (std::uint32_t i = 0; i < parent.size(); ++i) parent[i] = root(i);
  return parent;
}

/// Whether each edge has a triangle on either side.
bool is_closed(const Surfaces& surfaces, const Indices& numbers) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges, reversed;
  for (const auto& triangle : surfaces.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = numbers[triangle[k]], b = numbers[triangle[(k + 1) % 3]];
      if (a == b) continue;
      edges.emplace_back(a, b);
      reversed.emplace_back(b, a);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::sort(reversed.begin(), reversed.end());
  return !edges.empty() && edges == reversed;
}

/// The volume that surfaces enclose; 0 where they have a hole, or their front faces look inwards.
double enclosed_volume(const Surfaces& surfaces) {
  constexpr double kSamePlace = 1e-6;  // of the diagonal
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& p : surfaces.points) bounds.extend(p);
  if (surfaces.triangles.empty() || !(bounds.diagonal().norm() > 0.0)) return 0.0;
  if (!is_closed(surfaces, weld(surfaces.points, 0.0)) &&
      !is_closed(surfaces, weld(surfaces.points, kSamePlace * bounds.diagonal().norm())))
    return 0.0;
  double six_volumes = 0.0;
  const Eigen::Vector3d center = bounds.center();
  for (const auto& [a, b, c] : surfaces.triangles) {
    six_volumes +=
        (surfaces.points[a] - center).dot((surfaces.points[b] - center).cross(surfaces.points[c] - center));
  }
  return std::max(0.0, six_volumes / 6.0);
}

/// The volumes that instances of one placement enclose. Placements that share all their meshes are measured
/// once.
class EnclosedVolumes {
 public:
  explicit EnclosedVolumes(const Scene& scene) : scene_(scene) {}

  double operator()(const Indices& instances) {
    std::vector<int> meshes;
    bool shared = true;
    for (const std::uint32_t i : instances) {
      meshes.push_back(scene_.instances[i].mesh);
      shared = shared && !scene_.instances[i].baked;
    }
    if (!shared) return enclosed_volume(surfaces_of(instances, true));
    const auto [known, is_new] = known_.try_emplace(meshes, 0.0);
    if (is_new) known->second = enclosed_volume(surfaces_of(instances, false));
    const Affine& transform = scene_.instances[instances.front()].transform;
    return known->second * std::abs(transform.linear().cast<double>().determinant());
  }

 private:
  Surfaces surfaces_of(const Indices& instances, bool in_world) const {
    Surfaces surfaces;
    for (const std::uint32_t index : instances) {
      const Instance& instance = scene_.instances[index];
      const Mesh& mesh = scene_.mesh_of(instance);
      const auto first = static_cast<std::uint32_t>(surfaces.points.size());
      for (const Vec3& p : mesh.positions)
        surfaces.points.push_back((in_world ? Vec3(instance.transform * p) : p).cast<double>());
      for (const auto& [a, b, c] : mesh.triangles) {
        surfaces.triangles.push_back({first + a, first + b, first + c});
        if (in_world && instance.swaps_handedness)
          std::swap(surfaces.triangles.back()[1], surfaces.triangles.back()[2]);
      }
    }
    return surfaces;
  }

  const Scene& scene_;
  std::map<std::vector<int>, double> known_;  ///< by meshes, before they are placed
};

/// Bodies that are not closed by themselves become one body if all of their placement are closed together, or
/// together with its opaque surfaces.
std::vector<GlassBody> closed_bodies(const Scene& scene, std::vector<GlassBody> bodies) {
  EnclosedVolumes enclosed(scene);
  std::vector<GlassBody> closed;
  std::map<int, GlassBody> open;  // by placement
  for (GlassBody& body : bodies) {
    body.volume = enclosed(body.instances);
    if (body.volume > 0.0) {
      closed.push_back(std::move(body));
      continue;
    }
    GlassBody& rest = open[body.placement(scene)];
    rest.instances.insert(rest.instances.end(), body.instances.begin(), body.instances.end());
    rest.bounds.extend(body.bounds);
  }
  if (open.empty()) return closed;
  std::map<int, Indices> opaque;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Material& material = scene.material_of(instance);
    if (open.contains(instance.placement) && !material.has_volume() && can_close(material))
      opaque[instance.placement].push_back(i);
  }
  for (auto& [placement, body] : open) {
    std::sort(body.instances.begin(), body.instances.end());
    body.volume = enclosed(body.instances);
    if (body.volume == 0.0 && opaque.contains(placement)) {
      body.closing = opaque[placement];
      Indices all = body.instances;
      all.insert(all.end(), body.closing.begin(), body.closing.end());
      body.volume = enclosed(all);
    }
    if (body.volume > 0.0) closed.push_back(std::move(body));
  }
  return closed;
}

}  // namespace

NestedVolumes find_nested_volumes(const Scene& scene, bool all) {
  std::vector<GlassBody> bodies =
      find_bodies(scene, [](const Instance& instance, const Material&) { return instance.placement >= 0; });
  if (!all) keep_those_that_touch(bodies);
  bodies = closed_bodies(scene, std::move(bodies));
  if (!all) keep_those_that_touch(bodies);
  const auto strength = [&](const GlassBody& body) {
    const std::uint32_t first = body.instances.front();
    // Volumes that differ by rounding are the same.
    return std::tuple(-scene.instances[first].dielectric_priority, std::llround(1e4 * std::log(body.volume)),
                      body.placement(scene), first);
  };
  std::sort(bodies.begin(), bodies.end(),
            [&](const GlassBody& a, const GlassBody& b) { return strength(a) < strength(b); });
  NestedVolumes nested;
  if (bodies.empty()) return nested;
  nested.of_instance.assign(scene.instances.size(), kNoVolume);
  for (const GlassBody& body : bodies) {
    for (const std::uint32_t instance : body.instances)
      nested.of_instance[instance] = static_cast<std::uint32_t>(nested.instances.size());
    nested.instances.push_back(body.instances.front());
  }
  return nested;
}

double enclosed_volume(const Scene& scene, std::uint32_t instance) {
  return EnclosedVolumes(scene)({instance});
}

std::vector<EnclosedBody> find_bodies_at(const Scene& scene, const Box& places) {
  std::vector<GlassBody> bodies =
      find_bodies(scene, [](const Instance& instance, const Material&) { return instance.placement >= 0; });
  // Those that only together close may lie apart, so all of a placement are kept or none.
  std::set<int> near;
  for (const GlassBody& body : bodies) {
    if (body.bounds.intersects(places)) near.insert(body.placement(scene));
  }
  std::erase_if(bodies, [&](const GlassBody& body) { return !near.contains(body.placement(scene)); });
  std::vector<EnclosedBody> found;
  for (GlassBody& body : closed_bodies(scene, std::move(bodies))) {
    if (body.bounds.intersects(places)) found.push_back({std::move(body.instances), std::move(body.closing)});
  }
  return found;
}

std::vector<int> open_scatterers(const Scene& scene) {
  std::vector<std::uint8_t> closed(scene.instances.size(), 0);
  std::set<int> open;
  const auto scatters = [](const Instance&, const Material& material) { return material.scatters(); };
  for (const GlassBody& body : closed_bodies(scene, find_bodies(scene, scatters))) {
    for (const std::uint32_t instance : body.instances) closed[instance] = 1;
  }
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (!closed[i] && !scene.mesh_of(instance).triangles.empty() && scene.material_of(instance).scatters())
      open.insert(scene.mesh_of(instance).material);
  }
  return {open.begin(), open.end()};
}

}  // namespace gatelight::scene

#include "scene/coincident_surfaces.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scene/nested_volumes.h"

namespace gatelight::scene {
namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

constexpr std::uint32_t kSeveral = ~0u;

/// Of a ray, over the largest coordinate (renderer/surface/rounding.h).
constexpr float kOffset = 16.0f * 0x1p-23f;

/// Beyond this many triangles that let light pass, as leaves do, none is compared.
constexpr std::size_t kMaxPassing = std::size_t{1} << 22;

bool passes(const Scene& scene, const Instance& instance) {
  const Mesh& mesh = scene.mesh_of(instance);
  const Material& material = scene.material_of(instance);
  return material.transmits() && !material.culled && mesh.deforming < 0 && !mesh.triangles.empty();
}

Triangle corners_of(const Scene& scene, const Instance& instance, std::uint32_t primitive) {
  const std::array<Vec3, 3> p = world_triangle(scene, instance, primitive);
  return {p[0].cast<double>(), p[1].cast<double>(), p[2].cast<double>()};
}

Box box_of(const Scene& scene, const Instance& instance, std::uint32_t primitive) {
  Box box;
  const Mesh& mesh = scene.mesh_of(instance);
  for (const std::uint32_t corner : mesh.triangles[primitive]) {
    const Vec3& p = mesh.positions[corner];
    box.extend(instance.baked ? p : Vec3(instance.transform * p));
  }
  return box;
}

/// The front's, and as long as twice the area.
Eigen::Vector3d front_of(const Triangle& t, const Instance& instance) {
  const Eigen::Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
  return instance.swaps_handedness ? Eigen::Vector3d(-n) : n;
}

/// Whether the projections onto the plane perpendicular to `axis` overlap by more than their edges.
bool overlap(const Triangle& a, const Triangle& b, Eigen::Index axis, double tolerance) {
  const Eigen::Index x = (axis + 1) % 3, y = (axis + 2) % 3;
  for (const Triangle* t : {&a, &b}) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d edge = (*t)[(k + 1) % 3] - (*t)[k];
      const Eigen::Vector2d across = Eigen::Vector2d(-edge[y], edge[x]).stableNormalized();
      double low[2], high[2];
      for (const auto& [triangle, i] : {std::pair(&a, 0), std::pair(&b, 1)}) {
        low[i] = kInfinity;
        high[i] = -kInfinity;
        for (const Eigen::Vector3d& p : *triangle) {
          const double place = across.x() * p[x] + across.y() * p[y];
          low[i] = std::min(low[i], place);
          high[i] = std::max(high[i], place);
        }
      }
      if (!(std::min(high[0], high[1]) - std::max(low[0], low[1]) > tolerance)) return false;
    }
  }
  return true;
}

/// Whether the triangles lie in one plane, up to the tolerance in metres, and overlap there.
bool coincide(const Triangle& a, const Eigen::Vector3d& front_a, const Triangle& b,
              const Eigen::Vector3d& front_b, double tolerance) {
  const bool larger = front_a.squaredNorm() > front_b.squaredNorm();
  const Eigen::Vector3d n = (larger ? front_a : front_b).stableNormalized();
  const Triangle &plane = larger ? a : b, &other = larger ? b : a;
  for (const Eigen::Vector3d& p : other) {
    if (!(std::abs(n.dot(p - plane[0])) <= tolerance)) return false;
  }
  Eigen::Index axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  return overlap(a, b, axis, tolerance);
}

/// Finds the triangles of some instances in a box.
class PassingTriangles {
 public:
  struct Item {
    Box box;
    std::uint32_t instance, primitive;
  };

  explicit PassingTriangles(std::vector<Item> items) : items_(std::move(items)) { build(0, items_.size()); }

  /// Calls visit(item) for those whose boxes intersect this one, but for those of the instance.
  template <class Visit>
  void each_in(const Box& box, std::uint32_t but, const Visit& visit) const {
    std::size_t waiting[64], count = 0;
    waiting[count++] = 0;
    while (count > 0) {
      const Node& node = nodes_[waiting[--count]];
      if (node.instance == but || !node.box.intersects(box)) continue;
      if (node.second > 0) {
        waiting[count++] = static_cast<std::size_t>(&node - nodes_.data()) + 1;
        waiting[count++] = node.second;
        continue;
      }
      for (const Item& item : std::span(items_).subspan(node.first, node.count)) {
        if (item.instance != but && item.box.intersects(box)) visit(item);
      }
    }
  }

 private:
  struct Node {
    Box box;
    std::uint32_t instance;  ///< of all items; or kSeveral
    std::size_t second = 0;  ///< the second child, behind the first one; 0: a leaf
    std::size_t first, count;
  };

  void build(std::size_t begin, std::size_t end) {
    constexpr std::size_t kLeaf = 16;
    const std::size_t at = nodes_.size();
    Node node{.box = {}, .instance = items_[begin].instance, .first = begin, .count = end - begin};
    Box middles;
    for (std::size_t i = begin; i < end; ++i) {
      node.box.extend(items_[i].box);
      middles.extend(items_[i].box.center());
      if (items_[i].instance != node.instance) node.instance = kSeveral;
    }
    nodes_.push_back(node);
    if (end - begin <= kLeaf) return;
    Eigen::Index axis = 0;
    middles.sizes().maxCoeff(&axis);
    const std::size_t middle = (begin + end) / 2;
    const auto item = [&](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(item(begin), item(middle), item(end), [axis](const Item& a, const Item& b) {
      return a.box.center()[axis] < b.box.center()[axis];
    });
    build(begin, middle);
    nodes_[at].second = nodes_.size();
    build(middle, end);
  }

  std::vector<Item> items_;
  std::vector<Node> nodes_;
};

/// An instance that lets light pass, and one that coincides with it.
struct Pair {
  std::uint32_t passing, other;

  auto operator<=>(const Pair&) const = default;
};

/// Whether some triangles of a pair face the same way, and some opposite ways.
struct Facing {
  bool same = false, opposite = false;
};

using Pairs = std::map<Pair, Facing>;

class PlaneSeparator {
 public:
  explicit PlaneSeparator(Scene& scene) : scene_(scene) {}

  void separate() {
    std::size_t count = 0;
    for (const Instance& instance : scene_.instances) {
      if (passes(scene_, instance)) count += scene_.mesh_of(instance).triangles.size();
    }
    if (count == 0 || count > kMaxPassing) return;
    find_pairs();
    if (pairs_.empty()) return;
    choose_distances();
    const std::vector<std::vector<std::uint32_t>> placements = find_placements();
    moved_.assign(scene_.meshes.size(), 0);
    for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
      if (distances_[static_cast<std::size_t>(scene_.instances[i].mesh)] > 0.0f) move(i, placements);
    }
  }

 private:
  bool is_body(std::uint32_t i) const { return scene_.material_of(scene_.instances[i]).has_volume(); }
  bool is_sheet(std::uint32_t i) const { return passes(scene_, scene_.instances[i]) && !is_body(i); }

  void find_pairs() {
    const std::vector<Instance>& instances = scene_.instances;
    const auto count = static_cast<std::uint32_t>(instances.size());
    offsets_.resize(count);
    std::vector<Box> boxes(count);
    tbb::parallel_for(std::uint32_t{0}, count, [&](std::uint32_t i) {
      Box& box = boxes[i];
      const Instance& instance = instances[i];
      for (const Vec3& p : scene_.mesh_of(instance).positions)
        box.extend(instance.baked ? p : Vec3(instance.transform * p));
      if (box.isEmpty()) return;
      const float largest = std::max({box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff(),
                                      instance.transform.translation().cwiseAbs().maxCoeff()});
      offsets_[i] = kOffset * largest;
      const Vec3 margin = Vec3::Constant(offsets_[i]);
      box = Box(box.min() - margin, box.max() + margin);
    });
    std::vector<PassingTriangles::Item> items;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!passes(scene_, instances[i])) continue;
      const Vec3 margin = Vec3::Constant(offsets_[i]);
      for (std::uint32_t t = 0; t < scene_.mesh_of(instances[i]).triangles.size(); ++t) {
        const Box box = box_of(scene_, instances[i], t);
        items.push_back({Box(box.min() - margin, box.max() + margin), i, t});
      }
    }
    const PassingTriangles triangles(std::move(items));
    tbb::enumerable_thread_specific<Pairs> found;
    tbb::parallel_for(std::uint32_t{0}, count, [&](std::uint32_t i) {
      const Mesh& mesh = scene_.mesh_of(instances[i]);
      if (mesh.deforming >= 0) return;
      // Most triangles are far from all that let light pass.
      Box near;
      triangles.each_in(boxes[i], i, [&](const PassingTriangles::Item& item) { near.extend(item.box); });
      if (near.isEmpty()) return;
      tbb::parallel_for(
          tbb::blocked_range<std::uint32_t>(0, static_cast<std::uint32_t>(mesh.triangles.size()), 1024),
          [&](const tbb::blocked_range<std::uint32_t>& range) {
            Pairs& pairs = found.local();
            for (std::uint32_t t = range.begin(); t < range.end(); ++t) compare(triangles, near, i, t, pairs);
          });
    });
    for (const Pairs& some : found) {
      for (const auto& [pair, facing] : some) {
        pairs_[pair].same |= facing.same;
        pairs_[pair].opposite |= facing.opposite;
      }
    }
  }

  /// `near`: bounds of all that could coincide with a triangle of the instance.
  void compare(const PassingTriangles& triangles, const Box& near, std::uint32_t i, std::uint32_t t,
               Pairs& found) const {
    const Instance& instance = scene_.instances[i];
    const Vec3 margin = Vec3::Constant(offsets_[i]);
    Box box = box_of(scene_, instance, t);
    box = Box(box.min() - margin, box.max() + margin);
    if (!box.intersects(near)) return;
    triangles.each_in(box, i, [&](const PassingTriangles::Item& item) {
      const Triangle a = corners_of(scene_, scene_.instances[item.instance], item.primitive);
      const Triangle b = corners_of(scene_, instance, t);
      const Eigen::Vector3d front_a = front_of(a, scene_.instances[item.instance]),
                            front_b = front_of(b, instance);
      const bool same = front_a.dot(front_b) > 0.0;
      const auto known = found.find({item.instance, i});
      if (known != found.end() && (same ? known->second.same : known->second.opposite)) return;
      if (!coincide(a, front_a, b, front_b, static_cast<double>(offsets_[item.instance] + offsets_[i])))
        return;
      Facing& facing = found[{item.instance, i}];
      (same ? facing.same : facing.opposite) = true;
    });
  }

  /// Sets by how much each mesh moves, in units of its space; 0: not. Of two that coincide and would move the
  /// same way, one moves further.
  void choose_distances() {
    constexpr int kRounds = 8;
    std::vector<float> distances(scene_.instances.size(), 0.0f);  // metres, by instance
    const auto apart = [&](const Pair& pair) {
      return 2.0f * (offsets_[pair.passing] + offsets_[pair.other]);
    };
    for (const auto& [pair, facing] : pairs_) {
      // A sheet makes way for a body, and of two sheets the later one.
      float& distance = distances[pair.passing];
      if (is_sheet(pair.passing) || !is_sheet(pair.other)) distance = std::max(distance, apart(pair));
    }
    for (int round = 0; round < kRounds; ++round) {
      for (const auto& [pair, facing] : pairs_) {
        float& distance = distances[pair.passing];
        if (is_behind(pair, facing)) distance = std::max(distance, distances[pair.other] + apart(pair));
      }
    }
    distances_.assign(scene_.meshes.size(), 0.0f);
    for (std::size_t i = 0; i < distances.size(); ++i) {
      if (!(distances[i] > 0.0f)) continue;
      const Eigen::JacobiSVD<Eigen::Matrix3f> svd(scene_.instances[i].transform.linear());
      const float scale = std::max(svd.singularValues().z(), 1e-4f * svd.singularValues().x());
      float& distance = distances_[static_cast<std::size_t>(scene_.instances[i].mesh)];
      distance = std::max(distance, distances[i] / scale);
    }
  }

  /// Whether the first of a pair must move further than the second.
  bool is_behind(const Pair& pair, const Facing& facing) const {
    if (is_sheet(pair.passing)) return !is_sheet(pair.other) || pair.passing > pair.other;
    if (!is_body(pair.other) || !facing.same) return false;
    const double size = volume_of(pair.passing), other = volume_of(pair.other);
    return size > other || (size == other && pair.passing > pair.other);
  }

  double volume_of(std::uint32_t i) const { return enclosed_volume(scene_, i); }

  /// The instances of each placement.
  std::vector<std::vector<std::uint32_t>> find_placements() const {
    std::vector<std::vector<std::uint32_t>> placements;
    for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
      const auto placement = static_cast<std::size_t>(std::max(scene_.instances[i].placement, -1) + 1);
      if (placement == 0) continue;
      if (placements.size() <= placement) placements.resize(placement + 1);
      placements[placement].push_back(i);
    }
    return placements;
  }

  void move(std::uint32_t i, const std::vector<std::vector<std::uint32_t>>& placements) {
    const Instance& instance = scene_.instances[i];
    std::vector<std::uint32_t> parts{i};
    if (is_body(i) && instance.placement >= 0 && !(volume_of(i) > 0.0)) {
      // Parts that are open may close together, and stay so.
      parts = placements[static_cast<std::size_t>(instance.placement) + 1];
      std::erase_if(parts, [&](std::uint32_t part) { return part != i && volume_of(part) > 0.0; });
    }
    std::vector<int> meshes;
    for (const std::uint32_t part : parts) {
      const int mesh = scene_.instances[part].mesh;
      if (std::exchange(moved_[static_cast<std::size_t>(mesh)], 1) == 0) meshes.push_back(mesh);
    }
    if (meshes.empty()) return;
    const float distance = distances_[static_cast<std::size_t>(instance.mesh)];
    move(meshes, outwards(i) ? distance : -distance);
  }

  /// Whether it moves towards its own front: bodies do; sheets move to the front of what they lie on.
  bool outwards(std::uint32_t i) const {
    if (is_body(i)) return true;
    bool same = true, found = false;
    for (const auto& [pair, facing] : pairs_) {
      if (pair.passing != i || (found && is_sheet(pair.other))) continue;
      found = true;
      same = facing.same;
      if (!is_sheet(pair.other)) break;
    }
    return same;
  }

  /// Moves all triangles of the meshes along their normals, in units of the meshes' space. Vertices at the
  /// same place stay together.
  void move(const std::vector<int>& meshes, float distance) {
    static constexpr double kSharpest =
        0.25;  // smallest cosine between a vertex's direction and its triangles
    struct Vertex {
      Eigen::Vector3d direction = Eigen::Vector3d::Zero();
      double cosine = 1.0;
    };
    struct Hash {
      std::size_t operator()(const std::array<float, 3>& p) const {
        std::size_t hash = 0;
        for (const float x : p) {
          std::uint32_t bits = 0;
          std::memcpy(&bits, &x, sizeof bits);
          hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
        }
        return hash ^ hash >> 32;
      }
    };
    std::unordered_map<std::array<float, 3>, Vertex, Hash> vertices;
    const auto vertex_at = [&](const Vec3& p) -> Vertex& {
      return vertices[{p.x() + 0.0f, p.y() + 0.0f, p.z() + 0.0f}];
    };
    const auto each_triangle = [&](const auto& visit) {
      for (const int m : meshes) {
        const Mesh& mesh = scene_.meshes[static_cast<std::size_t>(m)];
        for (const auto& corners : mesh.triangles) {
          std::array<Eigen::Vector3d, 3> p;
          for (std::size_t k = 0; k < 3; ++k) p[k] = mesh.positions[corners[k]].cast<double>();
          const Eigen::Vector3d n = (p[1] - p[0]).cross(p[2] - p[0]).stableNormalized();
          for (std::size_t k = 0; k < 3; ++k) {
            const Eigen::Vector3d a = (p[(k + 1) % 3] - p[k]).stableNormalized(),
                                  b = (p[(k + 2) % 3] - p[k]).stableNormalized();
            visit(vertex_at(mesh.positions[corners[k]]), n, std::acos(std::clamp(a.dot(b), -1.0, 1.0)));
          }
        }
      }
    };
    each_triangle([](Vertex& v, const Eigen::Vector3d& n, double angle) { v.direction += angle * n; });
    for (auto& [place, vertex] : vertices) vertex.direction = vertex.direction.stableNormalized();
    each_triangle([](Vertex& v, const Eigen::Vector3d& n, double) {
      if (n.squaredNorm() > 0.0) v.cosine = std::min(v.cosine, std::max(n.dot(v.direction), kSharpest));
    });
    for (const int m : meshes) {
      for (Vec3& p : scene_.meshes[static_cast<std::size_t>(m)].positions) {
        const Vertex& v = vertex_at(p);
        p = (p.cast<double>() + v.direction * (static_cast<double>(distance) / v.cosine)).cast<float>();
      }
    }
  }

  Scene& scene_;
  std::vector<float> offsets_;  ///< of rays, by instance
  Pairs pairs_;
  std::vector<float> distances_;  ///< by mesh
  std::vector<char> moved_;       ///< by mesh
};

}  // namespace

void separate_coincident_surfaces(Scene& scene) {
  PlaneSeparator(scene).separate();
}

}  // namespace gatelight::scene

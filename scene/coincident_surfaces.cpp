#include "scene/coincident_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scene/coincident_instances.h"
#include "scene/nested_volumes.h"

namespace gatelight::scene {
namespace {

class PlaneSeparator {
 public:
  explicit PlaneSeparator(Scene& scene) : scene_(scene), found_(find_coincident_instances(scene)) {}

  void separate() {
    if (found_.pairs.empty()) return;
    choose_distances();
    const std::vector<std::vector<std::uint32_t>> placements = find_placements();
    moved_.assign(scene_.meshes.size(), 0);
    for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
      if (distances_[static_cast<std::size_t>(scene_.instances[i].mesh)] > 0.0f) move(i, placements);
    }
  }

 private:
  bool is_body(std::uint32_t i) const { return scene_.material_of(scene_.instances[i]).has_volume(); }
  bool is_sheet(std::uint32_t i) const { return lets_light_pass(scene_, scene_.instances[i]) && !is_body(i); }

  /// Sets by how much each mesh moves, in units of its space; 0: not. Of two that coincide and would move the
  /// same way, one moves further.
  void choose_distances() {
    constexpr int kRounds = 8;
    std::vector<float> distances(scene_.instances.size(), 0.0f);  // metres, by instance
    const auto apart = [&](const InstancePair& pair) {
      return 2.0f * (found_.offsets[pair.passing] + found_.offsets[pair.other]);
    };
    for (const auto& [pair, facing] : found_.pairs) {
      // A sheet makes way for a body, and of two sheets the later one.
      float& distance = distances[pair.passing];
      if (is_sheet(pair.passing) || !is_sheet(pair.other)) distance = std::max(distance, apart(pair));
    }
    std::vector<InstancePair> behind;  // asked once: it may measure volumes
    for (const auto& [pair, facing] : found_.pairs) {
      if (is_behind(pair, facing)) behind.push_back(pair);
    }
    for (int round = 0; round < kRounds; ++round) {
      for (const InstancePair& pair : behind) {
        float& distance = distances[pair.passing];
        distance = std::max(distance, distances[pair.other] + apart(pair));
      }
    }
    distances_.assign(scene_.meshes.size(), 0.0f);
    for (std::size_t i = 0; i < distances.size(); ++i) {
      if (!(distances[i] > 0.0f)) continue;
      const Eigen::JacobiSVD<Eigen::Matrix3f> svd(scene_.instances[i].transform.linear());
      const float scale = std::max(svd.singularValues().z(), 1e-4f * svd.singularValues().x());
      float& distance = distances_[static_cast<std::size_t>(scene_.instances[i].mesh)];
      if (scale > 0.0f) distance = std::max(distance, distances[i] / scale);
    }
  }

  /// Whether the first of a pair must move further than the second.
  bool is_behind(const InstancePair& pair, const Facing& facing) const {
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
    for (const auto& [pair, facing] : found_.pairs) {
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
  CoincidentInstances found_;
  std::vector<float> distances_;  ///< by mesh
  std::vector<char> moved_;       ///< by mesh
};

}  // namespace

void separate_coincident_surfaces(Scene& scene) {
  PlaneSeparator(scene).separate();
}

}  // namespace gatelight::scene

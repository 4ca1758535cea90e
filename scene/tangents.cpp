#include "scene/tangents.h"

#include <cmath>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include "scene/corner_topology.h"

namespace gatelight::scene {
namespace {

using Vec3d = Eigen::Vector3d;

/// The picture on a triangle.
struct Gradient {
  Vec3 tangent = Vec3::Zero();  ///< direction of increasing u, unit; zero if there is none
  std::int8_t side = 0;         ///< -1: u and -v turn clockwise on the front; 0: not known yet
};

/// Applies `change` to each attribute that the mesh has. Tangents are not among them.
template <class Change>
void for_each_attribute(Mesh& mesh, const Change& change) {
  if (!mesh.positions.empty()) change(mesh.positions);
  if (!mesh.normals.empty()) change(mesh.normals);
  if (!mesh.uv0.empty()) change(mesh.uv0);
  if (!mesh.uv1.empty()) change(mesh.uv1);
  if (!mesh.colors.empty()) change(mesh.colors);
}

void unshare_vertices(Mesh& mesh) {
  for_each_attribute(mesh, [&](auto& rows) {
    std::remove_reference_t<decltype(rows)> selected;
    selected.reserve(3 * mesh.triangles.size());
    for (const auto& t : mesh.triangles) {
      for (const std::uint32_t i : t) selected.push_back(rows[i]);
    }
    rows = std::move(selected);
  });
  std::uint32_t next = 0;
  for (auto& t : mesh.triangles) t = {next++, next++, next++};
}

/// The triangles' normals, for a mesh of unshared vertices.
std::vector<Vec3> flat_normals(const Mesh& mesh) {
  std::vector<Vec3> normals;
  normals.reserve(mesh.positions.size());
  for (const auto& t : mesh.triangles) {
    const Vec3& p = mesh.positions[t[0]];
    Vec3 n = (mesh.positions[t[1]] - p).cross(mesh.positions[t[2]] - p).stableNormalized();
    if (!n.allFinite() || n.isZero()) n = Vec3::UnitZ();
    normals.insert(normals.end(), 3, n);
  }
  return normals;
}

Gradient gradient_of(const Mesh& mesh, std::span<const Vec2> uv, const TextureSlot& slot, const Triangle& t) {
  Gradient gradient;
  if (is_degenerate(t, mesh.positions)) return gradient;
  const Eigen::Matrix2f linear = slot.transform.leftCols<2>();
  const Vec2 d1 = linear * (uv[t[1]] - uv[t[0]]);
  const Vec2 d2 = linear * (uv[t[2]] - uv[t[0]]);
  const Vec3 e1 = mesh.positions[t[1]] - mesh.positions[t[0]];
  const Vec3 e2 = mesh.positions[t[2]] - mesh.positions[t[0]];
  const float determinant = d1.x() * d2.y() - d1.y() * d2.x();
  if (!(std::abs(determinant) > std::numeric_limits<float>::min())) return gradient;
  const Vec3 along_u = (e1 * d2.y() - e2 * d1.y()).stableNormalized();
  const Vec3 along_v = e2 * d1.x() - e1 * d2.x();
  if (!along_u.allFinite() || along_u.isZero(0.0f) || along_v.isZero(0.0f)) return gradient;
  // In the picture, glTF's v points down and the map's green channel points up. An unmirrored picture
  // therefore has a negative determinant on a counter-clockwise triangle.
  gradient.side = determinant < 0.0f ? 1 : -1;
  gradient.tangent = determinant < 0.0f ? Vec3(-along_u) : along_u;
  return gradient;
}

/// Gives the triangles without a gradient the side of the nearest ones that have one, counted in edges. Among
/// equally near ones, those that are not mirrored win: the order of the triangles must not matter.
void spread_sides(std::span<Gradient> gradients, std::span<const std::uint32_t> neighbors) {
  std::vector<std::uint32_t> reached;
  for (const std::int8_t side : {std::int8_t{1}, std::int8_t{-1}}) {
    for (std::uint32_t c = 0; c < neighbors.size(); ++c) {
      if (neighbors[c] == kNoCorner || gradients[c / 3].side != 0) continue;
      const Gradient& other = gradients[neighbors[c] / 3];
      if (other.side != side || other.tangent.isZero(0.0f)) continue;
      gradients[c / 3].side = side;
      reached.push_back(c / 3);
    }
  }
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (std::uint32_t c = 3 * reached[i]; c < 3 * reached[i] + 3; ++c) {
      if (neighbors[c] == kNoCorner) continue;
      const std::uint32_t other = neighbors[c] / 3;
      if (gradients[other].side != 0) continue;
      gradients[other].side = gradients[reached[i]].side;
      reached.push_back(other);
    }
  }
}

/// A unit vector in the plane of the normal, or zero.
Vec3 project(const Vec3& v, const Vec3& normal) {
  const Vec3 flat = v - normal * normal.dot(v);
  const float squared = flat.squaredNorm();
  if (squared > 1e-30f && squared < 1e30f) return flat / std::sqrt(squared);
  return flat.stableNormalized();
}

class Generator {
 public:
  Generator(Mesh& mesh, const TextureSlot& slot)
      : mesh_(mesh), flat_(mesh.normals.empty() ? flat_normals(mesh) : std::vector<Vec3>()) {
    const std::vector<Vec2>& uv = slot.texcoord == 0 ? mesh.uv0 : mesh.uv1;
    welded_ = weld_vertices(mesh.positions, normals(), uv);
    neighbors_ = connect_edges(mesh.triangles, mesh.positions, welded_);
    gradients_.resize(mesh.triangles.size());
    if (!uv.empty()) {
      for (std::size_t f = 0; f < gradients_.size(); ++f)
        gradients_[f] = gradient_of(mesh, uv, slot, mesh.triangles[f]);
    }
    spread_sides(gradients_, neighbors_);
  }

  void run() {
    mesh_.tangents.assign(mesh_.positions.size(), Vec4::Zero());  // zero: no corner has set it
    taken_.assign(welded_.size(), kNoCorner);
    done_.assign(neighbors_.size(), false);
    for (std::uint32_t c = 0; c < neighbors_.size(); ++c) {
      if (!done_[c] && !gradients_[c / 3].tangent.isZero(0.0f)) {
        collect_group(c);
        store_group();
      }
    }
    for (std::uint32_t c = 0; c < neighbors_.size(); ++c) {
      if (!done_[c]) take_over(c);
    }
  }

 private:
  std::span<const Vec3> normals() const { return flat_.empty() ? mesh_.normals : flat_; }
  std::uint32_t& vertex(std::uint32_t corner) { return mesh_.triangles[corner / 3][corner % 3]; }

  /// Collects the corners around a vertex that follow each other over edges, on one side of the picture.
  void collect_group(std::uint32_t start) {
    group_.clear();
    const std::int8_t side = gradients_[start / 3].side;
    const auto belongs = [&](std::uint32_t c) { return c != kNoCorner && gradients_[c / 3].side == side; };
    // The first corner, or any if they surround the vertex.
    std::uint32_t first = start;
    for (std::uint32_t c = neighbors_[previous_corner(start)]; belongs(c) && c != start;) {
      first = c;
      c = neighbors_[previous_corner(c)];
    }
    std::uint32_t c = first;
    do {
      done_[c] = true;
      group_.push_back(c);
      c = neighbors_[c] == kNoCorner ? kNoCorner : next_corner(neighbors_[c]);
    } while (belongs(c) && c != first);
  }

  /// The corner's angle, seen along the normal. Arctangents of floats differ between C libraries, and with
  /// them would the fingerprint of the scene; those of doubles have the same float.
  float projected_angle(std::uint32_t corner, const Vec3& normal) {
    const Vec3& p = mesh_.positions[vertex(corner)];
    const Vec3 a = project(mesh_.positions[vertex(next_corner(corner))] - p, normal);
    const Vec3 b = project(mesh_.positions[vertex(previous_corner(corner))] - p, normal);
    if (a.isZero(0.0f) || b.isZero(0.0f)) return 0.5f * kPi;  // an edge along the normal
    return static_cast<float>(std::atan2(double{a.cross(b).norm()}, double{a.dot(b)}));
  }

  /// The tangent of the group's corners.
  Vec4 group_tangent() {
    // The sum hardly depends on the order in double precision.
    Vec3d sum = Vec3d::Zero();
    double weight = 0.0;
    const Vec3& normal = normals()[vertex(group_.front())];
    for (const std::uint32_t c : group_) {
      const Vec3 tangent = project(gradients_[c / 3].tangent, normal);
      if (!tangent.allFinite() || tangent.isZero(0.0f)) continue;
      const float angle = projected_angle(c, normal);
      if (!std::isfinite(angle)) continue;
      sum += angle * tangent.cast<double>();
      weight += angle;
    }
    // Tangents that cancel, as at a pole, leave only rounding errors.
    constexpr double kMin = 1e-5;
    Vec3 tangent = any_perpendicular(normal);
    if (sum.norm() > kMin * weight) tangent = project(sum.normalized().cast<float>(), normal);
    return {tangent.x(), tangent.y(), tangent.z(), static_cast<float>(gradients_[group_.front() / 3].side)};
  }

  void store_group() {
    const Vec4 tangent = group_tangent();
    // Corners of one vertex mostly follow each other, and the copy serves them all.
    std::uint32_t original = kNoCorner, copy = kNoCorner;
    for (const std::uint32_t c : group_) {
      std::uint32_t& v = vertex(c);
      if (v != original) {
        original = v;
        copy = placed(v, tangent);
      }
      v = copy;
    }
  }

  /// Returns the vertex, or a copy of it where it has another tangent already.
  std::uint32_t placed(std::uint32_t v, const Vec4& tangent) {
    std::uint32_t& taken = taken_[welded_[v]];
    if (mesh_.tangents[v].isZero(0.0f)) {
      mesh_.tangents[v] = tangent;
      if (taken == kNoCorner) taken = v;
      return v;
    }
    if (mesh_.tangents[v] == tangent) return v;
    for_each_attribute(
        mesh_, [v](auto& rows) { rows.push_back(std::remove_reference_t<decltype(rows[v])>(rows[v])); });
    mesh_.tangents.push_back(tangent);
    return static_cast<std::uint32_t>(mesh_.tangents.size() - 1);
  }

  /// Gives a corner's vertex that no group has reached the tangent of an equal vertex, if there is one.
  void take_over(std::uint32_t corner) {
    const std::uint32_t v = vertex(corner);
    if (!mesh_.tangents[v].isZero(0.0f)) return;
    const std::uint32_t taken = taken_[welded_[v]];
    if (taken != kNoCorner) {
      mesh_.tangents[v] = mesh_.tangents[taken];
      return;
    }
    const Vec3 tangent = any_perpendicular(normals()[v]);
    const float side = gradients_[corner / 3].side < 0 ? -1.0f : 1.0f;
    mesh_.tangents[v] = Vec4(tangent.x(), tangent.y(), tangent.z(), side);
  }

  Mesh& mesh_;
  std::vector<Vec3> flat_;  ///< the normals of a mesh without its own
  std::vector<std::uint32_t> welded_;
  std::vector<std::uint32_t> neighbors_;
  std::vector<Gradient> gradients_;
  std::vector<std::uint32_t> taken_;  ///< by welded vertex: the first vertex with a tangent
  std::vector<bool> done_;            ///< by corner
  std::vector<std::uint32_t> group_;
};

}  // namespace

void generate_tangents(Mesh& mesh, const TextureSlot& slot) {
  if (mesh.normals.empty()) unshare_vertices(mesh);
  Generator(mesh, slot).run();
}

}  // namespace gatelight::scene

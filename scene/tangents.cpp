#include "scene/tangents.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>

namespace gatelight::scene {
namespace {

struct Frame {
  Vec3 tangent = Vec3::Zero();  ///< direction of increasing u; zero if u and v do not span the triangle
  bool mirrored = false;        ///< u and v turn clockwise on the front
};

/// Replaces the vertices by those with these indices, with all their attributes.
void select_vertices(Mesh& mesh, const std::vector<std::uint32_t>& indices) {
  const auto select = [&](auto& rows) {
    if (rows.empty()) return;
    std::remove_reference_t<decltype(rows)> selected;
    selected.reserve(indices.size());
    for (const std::uint32_t i : indices) selected.push_back(rows[i]);
    rows = std::move(selected);
  };
  select(mesh.positions);
  select(mesh.normals);
  select(mesh.uv0);
  select(mesh.uv1);
  select(mesh.colors);
}

void unshare_vertices(Mesh& mesh) {
  std::vector<std::uint32_t> corners;
  corners.reserve(mesh.triangles.size() * 3);
  for (auto& t : mesh.triangles) {
    for (std::uint32_t& i : t) {
      corners.push_back(i);
      i = static_cast<std::uint32_t>(corners.size() - 1);
    }
  }
  select_vertices(mesh, corners);
}

Frame triangle_frame(const Mesh& mesh, const std::vector<Vec2>& uv, const TextureSlot& slot,
                     const std::array<std::uint32_t, 3>& t) {
  const Eigen::Matrix2f linear = slot.transform.leftCols<2>();
  const Vec2 d1 = linear * (uv[t[1]] - uv[t[0]]);
  const Vec2 d2 = linear * (uv[t[2]] - uv[t[0]]);
  const Vec3 e1 = mesh.positions[t[1]] - mesh.positions[t[0]];
  const Vec3 e2 = mesh.positions[t[2]] - mesh.positions[t[0]];
  const float determinant = d1.x() * d2.y() - d1.y() * d2.x();
  Frame frame;
  // In the picture, glTF's v points down and the map's green channel points up. An unmirrored picture
  // therefore has a negative determinant on a counter-clockwise triangle.
  frame.mirrored = determinant > 0.0f;
  if (determinant != 0.0f) {
    const Vec3 along = e1 * d2.y() - e2 * d1.y();
    frame.tangent = (determinant < 0.0f ? Vec3(-along) : along).stableNormalized();
    if (!frame.tangent.allFinite()) frame.tangent.setZero();
  }
  return frame;
}

float corner_angle(const Mesh& mesh, const std::array<std::uint32_t, 3>& t, std::size_t corner) {
  const Vec3& p = mesh.positions[t[corner]];
  const Vec3 a = mesh.positions[t[(corner + 1) % 3]] - p;
  const Vec3 b = mesh.positions[t[(corner + 2) % 3]] - p;
  const float angle = std::atan2(a.cross(b).norm(), a.dot(b));
  return std::isfinite(angle) ? angle : 0.0f;
}

/// Splits vertices until none has triangles of both orientations. Returns the orientation for each vertex.
std::vector<char> split_mirrored(Mesh& mesh, const std::vector<Frame>& frames) {
  constexpr char kPlain = 1;
  constexpr char kMirrored = 2;
  std::vector<char> side(mesh.positions.size(), 0);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    if (frames[f].tangent.isZero()) continue;
    for (const std::uint32_t i : mesh.triangles[f]) side[i] |= frames[f].mirrored ? kMirrored : kPlain;
  }
  std::vector<std::uint32_t> kept(side.size());
  std::iota(kept.begin(), kept.end(), 0u);
  std::vector<std::uint32_t> copy_of(side.size(), 0);
  for (std::uint32_t i = 0; i < side.size(); ++i) {
    if (side[i] != (kPlain | kMirrored)) continue;
    side[i] = kPlain;
    copy_of[i] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(i);
  }
  if (kept.size() == side.size()) return side;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    if (!frames[f].mirrored || frames[f].tangent.isZero()) continue;
    for (std::uint32_t& i : mesh.triangles[f]) {
      if (copy_of[i] != 0) i = copy_of[i];
    }
  }
  select_vertices(mesh, kept);
  side.resize(mesh.positions.size(), kMirrored);
  return side;
}

}  // namespace

void generate_tangents(Mesh& mesh, const TextureSlot& slot) {
  if (mesh.normals.empty()) unshare_vertices(mesh);
  const std::vector<Vec2>& uv = slot.texcoord == 0 ? mesh.uv0 : mesh.uv1;
  std::vector<Frame> frames(mesh.triangles.size());
  if (!uv.empty()) {
    for (std::size_t f = 0; f < frames.size(); ++f)
      frames[f] = triangle_frame(mesh, uv, slot, mesh.triangles[f]);
  }
  const std::vector<char> side = split_mirrored(mesh, frames);

  std::vector<Vec3> sums(mesh.positions.size(), Vec3::Zero());
  std::vector<Vec3> flat(mesh.normals.empty() ? mesh.positions.size() : 0, Vec3::UnitZ());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const auto& t = mesh.triangles[f];
    for (std::size_t corner = 0; corner < 3; ++corner)
      sums[t[corner]] += corner_angle(mesh, t, corner) * frames[f].tangent;
    if (flat.empty()) continue;
    const Vec3 n = (mesh.positions[t[1]] - mesh.positions[t[0]])
                       .cross(mesh.positions[t[2]] - mesh.positions[t[0]])
                       .stableNormalized();
    if (n.allFinite() && !n.isZero()) std::fill_n(flat.begin() + t[0], 3, n);
  }

  mesh.tangents.resize(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
    const Vec3& n = flat.empty() ? mesh.normals[i] : flat[i];
    Vec3 tangent = (sums[i] - n * n.dot(sums[i])).stableNormalized();
    if (!tangent.allFinite() || tangent.squaredNorm() < 0.5f) tangent = any_perpendicular(n);
    mesh.tangents[i] = Vec4(tangent.x(), tangent.y(), tangent.z(), side[i] == 2 ? -1.0f : 1.0f);
  }
}

}  // namespace gatelight::scene

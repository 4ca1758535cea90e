#include "scene/gltf/deform.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace gatelight::scene::gltf {
namespace {

/// Sums of joint matrices times their weights.
struct Blend {
  JointMatrix matrix = JointMatrix::Zero();
  float weight = 0.0f;
};

template <typename Rows>
void add_target(const Vertices& vertices, const std::map<std::string, int>& target, const char* semantic,
                float weight, Selection selection, Rows& rows) {
  const auto found = target.find(semantic);
  if (found == target.end() || rows.empty()) return;
  std::vector<Vec3> offsets(rows.size());
  vertices.read(found->second, semantic, {3}, selection, 3, offsets.data()->data());
  tbb::parallel_for(std::size_t{0}, rows.size(),
                    [&](std::size_t i) { rows[i].template head<3>() += weight * offsets[i]; });
}

/// Adds a set of four joints for each vertex.
void add_set(const Document& document, const Vertices& vertices, int set, std::span<const JointMatrix> joints,
             Selection selection, std::vector<Blend>& blends) {
  using Row = std::array<float, 4>;
  std::vector<Row> numbers(blends.size()), weights(blends.size());
  vertices.read(fmt::format("JOINTS_{}", set), {4}, selection, 4, numbers.data()->data());
  vertices.read(fmt::format("WEIGHTS_{}", set), {4}, selection, 4, weights.data()->data(), true);
  for (std::size_t i = 0; i < blends.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      if (!(weights[i][c] > 0.0f)) continue;
      const float number = numbers[i][c];
      if (!(number >= 0.0f && number < static_cast<float>(joints.size()))) {
        document.fail(vertices.where(),
                      fmt::format("joint {} in JOINTS_{} of vertex {}, expected less than {}", number, set,
                                  selection.empty() ? i : selection[i], joints.size()));
      }
      blends[i].matrix += weights[i][c] * joints[static_cast<std::size_t>(number)];
      blends[i].weight += weights[i][c];
    }
  }
}

/// Moves one vertex. Returns whether the matrix mirrors.
bool move_vertex(const JointMatrix& matrix, std::size_t i, Mesh& mesh) {
  const Eigen::Matrix3f linear = matrix.leftCols<3>();
  const Vec3 x = linear.col(0), y = linear.col(1), z = linear.col(2);
  mesh.positions[i] = linear * mesh.positions[i] + matrix.col(3);
  // Cofactors: the inverse transpose up to a factor, also where the matrix has no inverse.
  const Vec3 yz = y.cross(z);
  const bool mirrors = x.dot(yz) < 0.0f;
  const float side = mirrors ? -1.0f : 1.0f;
  if (!mesh.normals.empty()) {
    const Vec3 n = mesh.normals[i];
    mesh.normals[i] = side * (n.x() * yz + n.y() * z.cross(x) + n.z() * x.cross(y));
  }
  if (!mesh.tangents.empty()) {
    Vec4& tangent = mesh.tangents[i];
    tangent.head<3>() = linear * Vec3(tangent.head<3>());
    tangent.w() *= side;
  }
  return mirrors;
}

}  // namespace

void morph(const Vertices& vertices, const tinygltf::Primitive& primitive, std::span<const double> weights,
           Selection selection, Mesh& mesh) {
  for (std::size_t k = 0; k < std::min(weights.size(), primitive.targets.size()); ++k) {
    const auto weight = static_cast<float>(weights[k]);
    if (weight == 0.0f) continue;
    const std::map<std::string, int>& target = primitive.targets[k];
    add_target(vertices, target, "POSITION", weight, selection, mesh.positions);
    add_target(vertices, target, "NORMAL", weight, selection, mesh.normals);
    add_target(vertices, target, "TANGENT", weight, selection, mesh.tangents);
  }
}

void apply_skin(const Document& document, const Vertices& vertices, std::span<const JointMatrix> joints,
                Selection selection, Mesh& mesh, Warnings& warnings) {
  std::vector<Blend> blends(mesh.positions.size());
  const auto has_set = [&](int set) {
    return vertices.has(fmt::format("JOINTS_{}", set)) && vertices.has(fmt::format("WEIGHTS_{}", set));
  };
  if (!has_set(0)) warnings.add("a skinned mesh without joints and weights follows its skin's first joint");
  for (int set = 0; has_set(set); ++set) add_set(document, vertices, set, joints, selection, blends);
  std::vector<char> mirrored(blends.size(), 0);
  tbb::parallel_for(std::size_t{0}, blends.size(), [&](std::size_t i) {
    const Blend& blend = blends[i];
    const JointMatrix matrix = blend.weight > 0.0f ? JointMatrix(blend.matrix / blend.weight) : joints[0];
    mirrored[i] = move_vertex(matrix, i, mesh) ? 1 : 0;
  });
  // Front faces stay counter-clockwise.
  const auto count = static_cast<std::size_t>(std::count(mirrored.begin(), mirrored.end(), 1));
  if (2 * count <= mirrored.size()) return;
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

}  // namespace gatelight::scene::gltf

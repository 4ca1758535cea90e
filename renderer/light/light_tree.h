#pragma once
// A light tree: it chooses a light for a receiving point with a probability near the light's share of the
// light that could arrive there. Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with
// Adaptive Tree Splitting". A node has four children side by side in memory, and one step of the descent
// weighs all four.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"

namespace gatelight::renderer {

/// Bounds of a light, or of a group of lights.
struct LightBounds {
  Vec3 centre = Vec3::Zero();
  float radius = 0.0f;          ///< of a sphere around the centre that contains the light
  Vec3 axis{0.0f, 0.0f, 1.0f};  ///< unit; the cones of the next two members are around it
  float cos_normals = 1.0f;     ///< cosine of the half angle that contains all normals (-1: all directions)
  float cos_emission = 0.0f;    ///< cosine of the largest angle of emission from a normal
  bool two_sided = false;       ///< also emits around -axis
  double intensity = 0.0;       ///< in W/sr along the normal; lights with 0 are not in the tree
};

class LightTree {
 public:
  struct Choice {
    std::uint32_t light = 0;
    float probability = 0.0f;  ///< 0 means that no light is chosen
  };

  LightTree() = default;
  explicit LightTree(std::span<const LightBounds> lights);

  bool empty() const { return nodes_.empty(); }

  /// The importances of a node's four children for a point.
  struct Weights {
    alignas(16) float value[4];
    float sum = 0.0f;  ///< 0 means that none can reach the point
  };

  /// The first step of sample(). `n` is unit, or zero where light may arrive from all sides. The tree is not
  /// empty.
  Weights weigh_root(const Vec3& p, const Vec3& n) const { return weigh(nodes_[0], p, n); }

  /// `root` is the result of weigh_root(p, n), with a sum above zero. `u` is in [0, 1).
  Choice sample(const Weights& root, const Vec3& p, const Vec3& n, double u) const;

  /// The probability that sample(p, n) returns this light.
  float probability(const Vec3& p, const Vec3& n, std::uint32_t light) const;

  std::size_t bytes() const;

  /// For the kernels: the nodes as 48 numbers each (Node), and the lower bound of squared distances.
  const float* node_numbers() const { return nodes_.empty() ? nullptr : nodes_[0].centre_x; }
  float nearest2() const { return nearest2_; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr std::uint32_t kLeaf = 0x80000000u;

  /// Four children as a structure of arrays, in three cache lines. An unused child has intensity 0.
  struct alignas(64) Node {
    float centre_x[4], centre_y[4], centre_z[4];
    float radius[4];
    float axis_x[4], axis_y[4], axis_z[4];
    float cos_normals[4];
    float cos_emission[4];
    float side[4];           ///< -1 is two-sided, +1 is one-sided
    float intensity[4];      ///< divided by the intensity of the whole tree
    std::uint32_t child[4];  ///< a node, or a light with the bit kLeaf
  };
  static_assert(sizeof(Node) == 192);  // the kernels read 48 numbers

  Weights weigh(const Node& node, const Vec3& p, const Vec3& n) const;

  struct Builder;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> parents_;  ///< the slot of each node, 4 * parent + k; kNone for the root
  std::vector<std::uint32_t> places_;   ///< the slot of each light, 4 * node + k; kNone if not in the tree
  float nearest2_ = 0.0f;               ///< lower bound of the squared distance between receiver and light
};

}  // namespace gatelight::renderer

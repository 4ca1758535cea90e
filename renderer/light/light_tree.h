#pragma once
// A tree over lights that chooses one for a receiving point with a probability near its share of the light
// that could arrive: Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree
// Splitting". Four children a node, side by side in memory: one step of the descent weighs all four.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/math.h"

namespace gatelight::renderer {

using scene::Vec3;

/// What the tree knows of a light, or of a group of lights.
struct LightBounds {
  Vec3 centre = Vec3::Zero();
  float radius = 0.0f;          ///< of a sphere about the centre that holds the light
  Vec3 axis{0.0f, 0.0f, 1.0f};  ///< unit; the directions of emission lie within the cones about it:
  float cos_normals = 1.0f;     ///< cosine of the spread of the normals (-1: every direction)
  float cos_emission = 0.0f;    ///< cosine of how far from its normal light is emitted
  bool two_sided = false;       ///< emits about -axis too
  double intensity = 0.0;       ///< W/sr along the normal; lights without any are left out of the tree
};

class LightTree {
 public:
  struct Choice {
    std::uint32_t light = 0;
    float probability = 0.0f;  ///< 0: no light can reach the point
  };

  LightTree() = default;
  explicit LightTree(std::span<const LightBounds> lights);

  bool empty() const { return nodes_.empty(); }

  /// The importance of a node's four children for a point.
  struct Weights {
    alignas(16) float value[4];
    float sum = 0.0f;  ///< 0: none of them can shine there
  };

  /// The first step of sample(). n is unit, or zero where light may arrive from all sides. Not for an empty
  /// tree.
  Weights weigh_root(const Vec3& p, const Vec3& n) const { return weigh(nodes_[0], p, n); }

  /// `root` is what weigh_root(p, n) returned, its sum above zero. u in [0, 1).
  Choice sample(const Weights& root, const Vec3& p, const Vec3& n, double u) const;

  /// Probability that sample(p, n) returns this light.
  float probability(const Vec3& p, const Vec3& n, std::uint32_t light) const;

  std::size_t bytes() const;

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr std::uint32_t kLeaf = 0x80000000u;

  /// Four children in structure-of-arrays order: three cache lines. An unused child has no intensity.
  struct alignas(64) Node {
    float centre_x[4], centre_y[4], centre_z[4];
    float radius[4];
    float axis_x[4], axis_y[4], axis_z[4];
    float cos_normals[4];
    float cos_emission[4];
    float side[4];           ///< -1: two-sided, +1: one-sided
    float intensity[4];      ///< share of the whole tree's
    std::uint32_t child[4];  ///< a node, or a light with the bit kLeaf
  };
  static_assert(sizeof(Node) == 192);

  Weights weigh(const Node& node, const Vec3& p, const Vec3& n) const;

  struct Builder;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> parents_;  ///< for each node the place of its parent's slot; kNone for the root
  std::vector<std::uint32_t> places_;   ///< for each light its place, 4 * node + slot; kNone: not in the tree
  float nearest2_ = 0.0f;               ///< squared distance that receivers are kept away from a light
};

}  // namespace gatelight::renderer

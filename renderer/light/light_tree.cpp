#include "renderer/light/light_tree.h"

#include <algorithm>
#include <cmath>

namespace gatelight::renderer {

// Equation 3 of the paper for four children at once. The angles are: theta between the axis and the direction
// to the receiver, theta_o of the cone of normals, theta_b of the bounding sphere, and theta_i at the
// receiver.
//   theta'  = max(0, theta - theta_o - theta_b)   the smallest angle of emission in the group
//   theta_i' = max(0, theta_i - theta_b)          the smallest angle of incidence
//   importance = intensity * cos(theta') * cos(theta_i') / distance^2,  0 where theta' >= theta_e.
// Sines and cosines give the differences of angles. No branch depends on the data.
LightTree::Weights LightTree::weigh(const Node& node, const Vec3& p, const Vec3& n) const {
  Weights weights;
  const float px = p.x(), py = p.y(), pz = p.z();
  const float nx = n.x(), ny = n.y(), nz = n.z();
  // A receiver without a normal receives light from all sides.
  const float free = nx == 0.0f && ny == 0.0f && nz == 0.0f ? 1.0f : 0.0f;
  for (int k = 0; k < 4; ++k) {
    const float dx = node.centre_x[k] - px;
    const float dy = node.centre_y[k] - py;
    const float dz = node.centre_z[k] - pz;
    const float distance2 = dx * dx + dy * dy + dz * dz;
    // For a receiver within a group's sphere the distance is the radius.
    const float radius2 = node.radius[k] * node.radius[k];
    const float strength = node.intensity[k] / std::max(std::max(distance2, radius2), nearest2_);

    // The descent is a chain of dependent steps. Roots and quotients use lengths that are not normalised, so
    // that they need not wait for the inverse.
    const float safe2 = std::max(distance2, 1e-37f);
    const float inverse = 1.0f / std::sqrt(safe2);
    const float ratio2 = radius2 / safe2;
    const bool inside = ratio2 >= 1.0f;
    const float sin_b = inside ? 0.0f : node.radius[k] * inverse;
    const float cos_b = inside ? -1.0f : std::sqrt(std::max(0.0f, 1.0f - ratio2));

    const float along = -(dx * node.axis_x[k] + dy * node.axis_y[k] + dz * node.axis_z[k]);
    const float cos_w = std::max(along, node.side[k] * along) * inverse;
    const float sin_w = std::sqrt(std::max(0.0f, distance2 - along * along)) * inverse;
    const float cos_o = node.cos_normals[k];
    const float sin_o = std::sqrt(std::max(0.0f, 1.0f - cos_o * cos_o));
    const bool in_normals = cos_w > cos_o;
    const float cos_x = in_normals ? 1.0f : cos_w * cos_o + sin_w * sin_o;
    const float sin_x = in_normals ? 0.0f : sin_w * cos_o - cos_w * sin_o;
    const float cos_emitted = cos_x > cos_b ? 1.0f : cos_x * cos_b + sin_x * sin_b;
    const float emitted = cos_emitted > node.cos_emission[k] ? cos_emitted : 0.0f;

    const float up = dx * nx + dy * ny + dz * nz;
    const float cos_i = up * inverse;
    const float sin_i = std::sqrt(std::max(0.0f, distance2 - up * up)) * inverse;
    const float cos_received = cos_i > cos_b ? 1.0f : cos_i * cos_b + sin_i * sin_b;
    const float received = std::max(free, cos_received);  // free is 0 or 1, so this also clamps to 0

    weights.value[k] = strength * (emitted * received);
  }
  weights.sum = (weights.value[0] + weights.value[1]) + (weights.value[2] + weights.value[3]);
  return weights;
}

LightTree::Choice LightTree::sample(const Weights& root, const Vec3& p, const Vec3& n, double u) const {
  Choice choice{0, 1.0f};
  Weights weights = root;
  std::uint32_t index = 0;
  while (weights.sum > 0.0f) {
    // The first child whose running sum exceeds the target. A child with weight 0 does not change the sum, so
    // it is never chosen.
    const double w0 = static_cast<double>(weights.value[0]);
    const double w1 = w0 + static_cast<double>(weights.value[1]);
    const double w2 = w1 + static_cast<double>(weights.value[2]);
    const double w3 = w2 + static_cast<double>(weights.value[3]);
    const double target = u * w3;
    const int slot = (target >= w0 ? 1 : 0) + (target >= w1 ? 1 : 0) + (target >= w2 ? 1 : 0);
    const double low[4] = {0.0, w0, w1, w2};
    const double value = static_cast<double>(weights.value[slot]);
    u = std::min((target - low[slot]) / value, 0x1.fffffffffffffp-1);
    choice.probability *= weights.value[slot] / weights.sum;
    const std::uint32_t child = nodes_[index].child[slot];
    if (child & kLeaf) {
      choice.light = child & ~kLeaf;
      return choice;
    }
    index = child;
    weights = weigh(nodes_[index], p, n);
  }
  return {};
}

float LightTree::probability(const Vec3& p, const Vec3& n, std::uint32_t light) const {
  std::uint32_t place = places_[light];
  if (place == kNone) return 0.0f;
  float probability = 1.0f;
  while (place != kNone) {
    const Node& node = nodes_[place / 4];
    const Weights weights = weigh(node, p, n);
    const float value = weights.value[place % 4];
    if (!(value > 0.0f)) return 0.0f;
    probability *= value / weights.sum;
    place = parents_[place / 4];
  }
  return probability;
}

std::size_t LightTree::bytes() const {
  return nodes_.size() * sizeof(Node) + (parents_.size() + places_.size()) * sizeof(std::uint32_t);
}

}  // namespace gatelight::renderer

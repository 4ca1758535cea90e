#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "renderer/light/light_tree.h"

namespace gatelight::renderer {
namespace {

Box box_of(const LightBounds& light) {
  return {Vec3(light.centre.array() - light.radius), Vec3(light.centre.array() + light.radius)};
}

/// The light's axis; for a two-sided light the axis on the side of `towards`.
Vec3 axis_towards(const LightBounds& light, const Vec3& towards) {
  return light.two_sided && light.axis.dot(towards) < 0.0f ? Vec3(-light.axis) : light.axis;
}

/// A summary of a group of lights that is cheap to merge, for comparing splits. The spread of the normals is
/// estimated from the length of their mean, which is (1 + cos t) / 2 for a uniform cap of half angle t.
struct Summary {
  Box box;
  Vec3 axes = Vec3::Zero();
  double intensity = 0.0;
  float cos_emission = 1.0f;
  int count = 0;
  bool all_directions = false;

  void add(const LightBounds& light, const Vec3& towards) {
    box.extend(box_of(light));
    axes += axis_towards(light, towards);
    intensity += light.intensity;
    cos_emission = std::min(cos_emission, light.cos_emission);
    ++count;
    all_directions |= light.cos_normals <= -1.0f;
  }
  void add(const Summary& other) {
    box.extend(other.box);
    axes += other.axes;
    intensity += other.intensity;
    cos_emission = std::min(cos_emission, other.cos_emission);
    count += other.count;
    all_directions |= other.all_directions;
  }

  /// Section 4.4 of the paper: intensity times the surface of the box times the measure of the directions. A
  /// small part of the squared diagonal distinguishes flat and thin groups.
  float cost() const {
    const float cos_o = all_directions
                            ? -1.0f
                            : std::clamp(2.0f * axes.norm() / static_cast<float>(count) - 1.0f, -1.0f, 1.0f);
    const float theta_o = std::acos(cos_o);
    const float theta_w = std::min(theta_o + std::acos(cos_emission), kPi);
    const float sin_o = std::sqrt(1.0f - cos_o * cos_o);
    const float directions =
        2.0f * kPi * (1.0f - cos_o) +
        0.5f * kPi *
            (2.0f * theta_w * sin_o - std::cos(theta_o - 2.0f * theta_w) - 2.0f * theta_o * sin_o + cos_o);
    const Vec3 d = box.sizes();
    const float area = 2.0f * (d.x() * d.y() + d.y() * d.z() + d.z() * d.x()) + 0.01f * d.squaredNorm();
    return static_cast<float>(intensity) * area * directions;
  }
};

}  // namespace

struct LightTree::Builder {
  struct Group {
    std::size_t begin = 0;
    std::size_t end = 0;
    std::size_t size() const { return end - begin; }
  };

  std::span<const LightBounds> lights;
  std::vector<std::uint32_t> order;
  double total = 0.0;
  LightTree& tree;

  const LightBounds& at(std::size_t i) const { return lights[order[i]]; }

  /// The bounds of a group, exact except for rounding.
  LightBounds bound(const Group& group) const {
    if (group.size() == 1) return at(group.begin);
    LightBounds b;
    Box box;
    Vec3 axes = Vec3::Zero();
    b.cos_emission = 1.0f;
    for (std::size_t i = group.begin; i < group.end; ++i) {
      const LightBounds& light = at(i);
      box.extend(box_of(light));
      axes += axis_towards(light, axes);
      b.intensity += light.intensity;
      b.two_sided |= light.two_sided;
      b.cos_emission = std::min(b.cos_emission, light.cos_emission);
    }
    b.centre = box.center();
    const float length = axes.norm();
    const bool directed = length > 1e-3f;
    if (directed) b.axis = axes / length;
    b.cos_normals = directed ? 1.0f : -1.0f;
    for (std::size_t i = group.begin; i < group.end; ++i) {
      const LightBounds& light = at(i);
      b.radius = std::max(b.radius, (light.centre - b.centre).norm() + light.radius);
      const float along = b.axis.dot(light.axis);
      const float cosine = std::clamp(light.two_sided ? std::abs(along) : along, -1.0f, 1.0f);
      b.cos_normals = std::min(b.cos_normals, widen(cosine, light.cos_normals));
    }
    // The margins keep all lights inside in spite of rounding.
    b.radius *= 1.0f + 1e-5f;
    b.cos_normals = std::max(-1.0f, b.cos_normals - 1e-6f);
    return b;
  }

  /// The cosine of the sum of two angles in [0, pi]; the sum is clamped to pi.
  static float widen(float cos_a, float cos_b) {
    if (cos_b >= 1.0f) return cos_a;
    if (cos_a <= -cos_b) return -1.0f;
    return cos_a * cos_b - std::sqrt((1.0f - cos_a * cos_a) * (1.0f - cos_b * cos_b));
  }

  /// Splits a group of at least two lights and returns where the second part begins.
  std::size_t split(const Group& group) {
    constexpr int kMaxBins = 12;
    const std::size_t middle = group.begin + group.size() / 2;
    if (group.size() == 2) return middle;
    Box centres;
    Vec3 towards = Vec3::Zero();
    for (std::size_t i = group.begin; i < group.end; ++i) {
      centres.extend(at(i).centre);
      towards += axis_towards(at(i), towards);
    }
    const Vec3 extent = centres.sizes();
    const int bins = group.size() > 32 ? kMaxBins : 6;
    const auto bin_of = [&](const LightBounds& light, int axis) {
      const float x = (light.centre[axis] - centres.min()[axis]) / extent[axis];
      return std::clamp(static_cast<int>(x * static_cast<float>(bins)), 0, bins - 1);
    };

    int best_axis = -1;
    int best_bin = 0;
    float best_cost = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(extent[axis] > 0.0f)) continue;
      std::array<Summary, kMaxBins> bin;
      for (std::size_t i = group.begin; i < group.end; ++i) {
        bin[static_cast<std::size_t>(bin_of(at(i), axis))].add(at(i), towards);
      }
      std::array<float, kMaxBins> right_cost{};
      Summary right;
      for (std::size_t b = static_cast<std::size_t>(bins) - 1; b > 0; --b) {
        if (bin[b].count > 0) right.add(bin[b]);
        right_cost[b] = right.count > 0 ? right.cost() : -1.0f;
      }
      Summary left;
      // The paper's regularisation prefers long axes, so that groups do not become thin slices.
      const float stretch = extent.maxCoeff() / extent[axis];
      for (std::size_t b = 1; b < static_cast<std::size_t>(bins); ++b) {
        if (bin[b - 1].count > 0) left.add(bin[b - 1]);
        if (left.count == 0 || right_cost[b] < 0.0f) continue;
        const float cost = stretch * (left.cost() + right_cost[b]);
        if (cost < best_cost) {
          best_cost = cost;
          best_axis = axis;
          best_bin = static_cast<int>(b);
        }
      }
    }
    const auto begin = order.begin() + static_cast<std::ptrdiff_t>(group.begin);
    const auto end = order.begin() + static_cast<std::ptrdiff_t>(group.end);
    if (best_axis >= 0) {
      const auto second = std::partition(
          begin, end, [&](std::uint32_t light) { return bin_of(lights[light], best_axis) < best_bin; });
      if (second != begin && second != end) return static_cast<std::size_t>(second - order.begin());
    }
    // All lights are in one place.
    return middle;
  }

  std::uint32_t build(const Group& all, std::uint32_t parent) {
    std::array<Group, 4> groups{all};
    std::size_t count = 1;
    while (count < 4) {
      // The largest group that can be split.
      std::size_t widest = 4;
      for (std::size_t i = 0; i < count; ++i) {
        if (groups[i].size() < 2) continue;
        if (widest == 4 || groups[i].size() > groups[widest].size()) widest = i;
      }
      if (widest == 4) break;
      const Group whole = groups[widest];
      const std::size_t second = split(whole);
      groups[widest] = {whole.begin, second};
      groups[count++] = {second, whole.end};
    }

    const auto index = static_cast<std::uint32_t>(tree.nodes_.size());
    tree.nodes_.emplace_back();
    tree.parents_.push_back(parent);
    for (std::size_t k = 0; k < 4; ++k) {
      const bool used = k < count;
      write(tree.nodes_[index], k, used ? bound(groups[k]) : LightBounds{});
      tree.nodes_[index].child[k] = kNone;
      if (!used) continue;
      const std::uint32_t place = 4 * index + static_cast<std::uint32_t>(k);
      if (groups[k].size() == 1) {
        const std::uint32_t light = order[groups[k].begin];
        tree.nodes_[index].child[k] = light | kLeaf;
        tree.places_[light] = place;
      } else {
        const std::uint32_t child = build(groups[k], place);
        tree.nodes_[index].child[k] = child;
      }
    }
    return index;
  }

  void write(Node& node, std::size_t k, const LightBounds& b) const {
    node.centre_x[k] = b.centre.x();
    node.centre_y[k] = b.centre.y();
    node.centre_z[k] = b.centre.z();
    node.radius[k] = b.radius;
    node.axis_x[k] = b.axis.x();
    node.axis_y[k] = b.axis.y();
    node.axis_z[k] = b.axis.z();
    node.cos_normals[k] = b.cos_normals;
    node.cos_emission[k] = b.cos_emission;
    node.side[k] = b.two_sided ? -1.0f : 1.0f;
    // A share below the range of a float still gets a value above 0.
    node.intensity[k] = b.intensity > 0.0 ? std::max(static_cast<float>(b.intensity / total), 1e-30f) : 0.0f;
  }
};

LightTree::LightTree(std::span<const LightBounds> lights) : places_(lights.size(), kNone) {
  Builder builder{.lights = lights, .order = {}, .tree = *this};
  Box box;
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    if (!(lights[i].intensity > 0.0)) continue;
    builder.order.push_back(i);
    builder.total += lights[i].intensity;
    box.extend(lights[i].centre);
  }
  if (builder.order.empty()) return;
  // A bound for receivers that touch a point light. A millionth of the lights' extent would be far for a tiny
  // lamp among huge ones.
  nearest2_ = std::max(1e-24f * box.sizes().squaredNorm(), 1e-36f);
  nodes_.reserve(builder.order.size() / 2 + 1);
  builder.build({0, builder.order.size()}, kNone);
  nodes_.shrink_to_fit();
  parents_.shrink_to_fit();
}

}  // namespace gatelight::renderer

#include "neural/layout/budget.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "neural/errors.h"

namespace gatelight::neural {

namespace {

constexpr std::uint64_t kMaxNodes = std::numeric_limits<std::uint32_t>::max();

float power_of_two(int exponent) {
  return std::ldexp(1.0f, std::clamp(exponent, -126, 127));
}

/// No coordinate of a vertex in world space is greater.
double coordinate_bound(const PlanScene& scene) {
  const SurfaceLayout& surfaces = scene.surfaces;
  std::vector<Double3> mesh_bounds(surfaces.meshes.size());
  tbb::parallel_for(std::size_t{0}, surfaces.meshes.size(), [&](std::size_t m) {
    Double3 bound = {0, 0, 0};
    for (const Float3& p : surfaces.meshes[m].positions)
      for (int c = 0; c < 3; ++c) bound[c] = std::max(bound[c], std::abs(double{p[c]}));
    mesh_bounds[m] = bound;
  });
  double greatest = 0.0;
  for (const std::uint32_t i : scene.stored) {
    Transform transform = to_transform(surfaces.instances[i].object_to_world);
    for (Double3& column : transform.columns)
      for (double& x : column) x = std::abs(x);
    greatest = std::max(
        greatest, std::ranges::max(transform_point(transform, mesh_bounds[surfaces.instances[i].mesh])));
  }
  return greatest;
}

/// The least and the greatest scale of the node spacing.
std::pair<float, float> scale_bounds(const PlanScene& scene) {
  if (scene.stored.empty()) return {1.0f, 1.0f};
  const auto scale = [&](std::uint32_t i) { return scene.surfaces.instances[i].spacing_scale; };
  const auto [least, greatest] = std::ranges::minmax_element(scene.stored, {}, scale);
  return {scale(*least), scale(*greatest)};
}

/// Between a value that gives a layout that fits and one that does not: one that fits beside one that does
/// not, `step` units in the last place apart. Works on the bits of positive floats, which are in their order.
template <class Fits>
float bisect(float good_value, float bad_value, std::uint32_t step, const Fits& fits) {
  auto good = std::bit_cast<std::uint32_t>(good_value);
  auto bad = std::bit_cast<std::uint32_t>(bad_value);
  while (std::max(good, bad) - std::min(good, bad) > step) {
    const std::uint32_t middle = std::min(good, bad) + (std::max(good, bad) - std::min(good, bad)) / 2;
    (fits(std::bit_cast<float>(middle)) ? good : bad) = middle;
  }
  return std::bit_cast<float>(good);
}

[[noreturn]] void throw_too_small(PlanScene& scene, const Density& coarsest) {
  const LayoutPlan least = *make_plan(scene, coarsest, std::numeric_limits<std::uint64_t>::max());
  const GateOptions& options = scene.options;
  throw BadConfiguration(fmt::format("memory budget: {} bytes, expected at least {}", options.memory_budget,
                                     least.node_count * options.features * options.bytes_per_feature));
}

Density solve_scale(PlanScene& scene, std::uint64_t limit) {
  Density density{.node_spacing = scene.options.node_spacing};
  const auto fits = [&](float scale) {
    density.resolution_scale = scale;
    return plan_fits(scene, density, limit);
  };
  const float finest = power_of_two(127);
  const float coarsest = power_of_two(-126);
  if (fits(finest)) return density;
  if (!fits(coarsest)) throw_too_small(scene, density);
  density.resolution_scale = bisect(coarsest, finest, 1, fits);
  return density;
}

Density solve_spacing(PlanScene& scene, std::uint64_t limit) {
  // At the coarsest spacing all lies in the cell at the origin, and all resolutions are 1. Powers of two: the
  // search is the same for a scene scaled by one.
  const double bound = coordinate_bound(scene);
  const auto [least_scale, greatest_scale] = scale_bounds(scene);
  const int exponent = bound > 0.0 ? std::ilogb(bound) + 4 : 0;
  const float coarsest = power_of_two(exponent - std::ilogb(least_scale));
  const float finest = power_of_two(exponent - 64 - std::ilogb(greatest_scale));
  Density density{.resolution_scale = scene.options.resolution_scale};
  const auto fits = [&](float spacing) {
    density.node_spacing = spacing;
    return plan_fits(scene, density, limit);
  };
  if (fits(finest)) return density;
  const bool clusters = scene.options.cluster && scene.options.storage == NodeStorage::shared;
  // Where vertices are clustered each trial takes time: then to a thousandth.
  const std::uint32_t step = clusters ? 1u << 13 : 1;
  using enum ClusterScope;
  for (const ClusterScope scope : {instance_and_normal, instance, scene_and_normal}) {
    density.scope = scope;
    if (fits(coarsest)) {
      density.node_spacing = bisect(coarsest, finest, step, fits);
      return density;
    }
    if (!clusters) break;
  }
  throw_too_small(scene, density);
}

}  // namespace

LayoutPlan solve_plan(PlanScene& scene) {
  const GateOptions& options = scene.options;
  Density density{options.node_spacing, options.resolution_scale};
  if (options.memory_budget == 0) {
    if (auto plan = make_plan(scene, density, kMaxNodes)) return *plan;
    throw BadConfiguration(
        "more than 2^32-1 nodes, expected fewer: a greater node spacing or a memory budget gives them");
  }
  const std::uint64_t limit =
      std::min(kMaxNodes, options.memory_budget / (options.features * options.bytes_per_feature));
  if (options.rule == ResolutionRule::uniform) density = solve_spacing(scene, limit);
  if (options.rule == ResolutionRule::paper) density = solve_scale(scene, limit);
  auto plan = make_plan(scene, density, limit);
  if (!plan) throw_too_small(scene, density);
  return *plan;
}

}  // namespace gatelight::neural

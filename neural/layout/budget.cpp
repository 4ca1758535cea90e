#include "neural/layout/budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "base/errors.h"
#include "base/parallel/loops.h"
#include "base/to_number.h"

namespace gatelight::neural {

namespace {

constexpr std::uint64_t kMaxNodes = std::numeric_limits<std::uint32_t>::max();

float power_of_two(int exponent) {
  return std::ldexp(1.0f, std::clamp(exponent, -126, 127));
}

/// Upper bound of the absolute coordinates of all vertices in world space.
double coordinate_bound(const PlanScene& scene) {
  const SurfaceLayout& surfaces = scene.surfaces;
  std::vector<Double3> mesh_bounds(surfaces.meshes.size());
  for_each(surfaces.meshes.size(), [&](std::size_t m) {
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

/// Smallest and largest spacing_scale of the stored instances.
std::pair<float, float> scale_bounds(const PlanScene& scene) {
  if (scene.stored.empty()) return {1.0f, 1.0f};
  const auto scale = [&](std::uint32_t i) { return scene.surfaces.instances[i].spacing_scale; };
  const auto [least, greatest] = std::ranges::minmax_element(scene.stored, {}, scale);
  return {scale(*least), scale(*greatest)};
}

/// Tolerance of the search in units in the last place (1.6 %), used with clusters because each trial takes
/// time then.
constexpr std::uint32_t kClusterTolerance = 1u << 17;

/// Bisects between a value that fits and one that does not until they differ by at most `step` units in the
/// last place; returns the one that fits. It works on the bits of positive floats, which have the same order
/// as the floats.
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

/// Increases a value that does not fit, in doubling steps that start at a quarter of an octave; trials that
/// do not fit end early. Returns the last value that does not fit and the first that does, or nullopt if even
/// `last` does not fit.
template <class Fits>
std::optional<std::pair<float, float>> bracket(float bad, float last, const Fits& fits) {
  for (std::uint64_t step = 1u << 21; bad < last; step *= 2) {
    const std::uint64_t bits = std::bit_cast<std::uint32_t>(bad) + step;
    const std::uint64_t most = std::bit_cast<std::uint32_t>(last);
    const float next = std::bit_cast<float>(static_cast<std::uint32_t>(std::min(bits, most)));
    if (fits(next)) return std::pair(bad, next);
    bad = next;
  }
  return std::nullopt;
}

class Search {
 public:
  Search(PlanScene& scene, std::uint64_t limit) : scene_(scene), limit_(limit) {}

  bool fits(const Density& density) {
    std::optional<LayoutPlan> plan;
    if (!plan_fits(scene_, density, limit_, plan)) return false;
    fitting_ = density;
    plan_ = plan ? std::make_unique<LayoutPlan>(std::move(*plan)) : nullptr;
    return true;
  }
  /// The plan of the last density that fitted.
  LayoutPlan plan() { return plan_ ? std::move(*plan_) : *make_plan(scene_, fitting_, limit_); }

 private:
  PlanScene& scene_;
  std::uint64_t limit_;
  Density fitting_;
  std::unique_ptr<LayoutPlan> plan_;
};

/// solve_scale and solve_spacing return false if nothing fits; `density` is then the coarsest one tried.
bool solve_scale(const GateOptions& options, Search& search, Density& density) {
  const auto fits = [&](float scale) {
    density.resolution_scale = scale;
    return search.fits(density);
  };
  const float finest = options.budget_is_cap ? options.resolution_scale : power_of_two(127);
  if (fits(finest)) return true;
  const float coarsest = power_of_two(-126);
  if (!fits(coarsest)) return false;
  bisect(coarsest, finest, 1, fits);
  return true;
}

bool solve_spacing(const PlanScene& scene, Search& search, Density& density) {
  // At the coarsest spacing all vertices lie in the cell at the origin and all resolutions are 1. The bounds
  // are powers of two, so that the search is the same for a scene scaled by a power of two.
  const GateOptions& options = scene.options;
  const double bound = coordinate_bound(scene);
  const auto [least_scale, greatest_scale] = scale_bounds(scene);
  const int exponent = bound > 0.0 ? std::ilogb(bound) + 4 : 0;
  float coarsest = power_of_two(exponent - std::ilogb(least_scale));
  float finest = power_of_two(exponent - 64 - std::ilogb(greatest_scale));
  if (options.budget_is_cap) {
    finest = options.node_spacing;
    coarsest = std::max(coarsest, 2.0f * std::min(finest, power_of_two(126)));
  }
  const auto fits = [&](float spacing) {
    density.node_spacing = spacing;
    return search.fits(density);
  };
  if (fits(finest)) return true;
  const bool clusters = options.cluster && options.storage == NodeStorage::shared;
  using enum ClusterScope;
  for (const ClusterScope scope : {instance_and_normal, instance, scene_and_normal}) {
    density.scope = scope;
    if (const auto between = bracket(finest, coarsest, fits)) {
      bisect(between->second, between->first, clusters ? kClusterTolerance : 1, fits);
      return true;
    }
    if (!clusters) break;
  }
  return false;
}

}  // namespace

LayoutPlan solve_plan(PlanScene& scene) {
  const GateOptions& options = scene.options;
  Density density{options.node_spacing, options.resolution_scale};
  const auto make_wanted = [&]() -> LayoutPlan {
    if (auto plan = make_plan(scene, {options.node_spacing, options.resolution_scale}, kMaxNodes))
      return std::move(*plan);
    throw BadConfiguration({"node-spacing", "", "needs more than 2^32-1 nodes",
                            "a greater one, or a limit with `cache-memory`"});
  };
  if (options.memory_budget == 0) return make_wanted();
  const std::uint64_t node_bytes = options.features * options.bytes_per_feature;
  Search search(scene, std::min(kMaxNodes, options.memory_budget / node_bytes));
  const bool found = options.rule == ResolutionRule::uniform ? solve_spacing(scene, search, density)
                     : options.rule == ResolutionRule::paper ? solve_scale(options, search, density)
                                                             : search.fits(density);
  if (found) return search.plan();
  if (options.budget_is_cap) return make_wanted();
  const LayoutPlan least = *make_plan(scene, density, std::numeric_limits<std::uint64_t>::max());
  throw BadConfiguration({"cache-memory", mebibytes_text(options.memory_budget), "MiB are too few",
                          "at least " + mebibytes_text(least.node_count * node_bytes)});
}

std::string mebibytes_text(std::uint64_t bytes) {
  constexpr double kMebibyte = 1048576.0;
  constexpr int kMaxDecimals = 20;  // 2^-20 has as many
  const auto wanted = static_cast<double>(bytes);
  for (int decimals = 0;; ++decimals) {
    const std::string text = fmt::format("{:.{}f}", wanted / kMebibyte, decimals);
    const bool same = std::ceil(to_number<double>(text).value() * kMebibyte) == wanted;
    if (same || decimals == kMaxDecimals) return text;
  }
}

}  // namespace gatelight::neural

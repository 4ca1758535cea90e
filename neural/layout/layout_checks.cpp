#include "neural/layout/layout_checks.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/parallel/loops.h"
#include "base/require.h"

namespace gatelight::neural {

namespace {

constexpr std::size_t kNotFound = std::numeric_limits<std::size_t>::max();

void require_positive(const char* option, float value) {
  require(value > 0.0f && std::isfinite(value), option, value, "a positive number");
}

/// The first bad index below count, or kNotFound.
template <class Bad>
std::size_t find_first(std::size_t count, const Bad& bad) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count, 16384), kNotFound,
      [&](const tbb::blocked_range<std::size_t>& range, std::size_t first) {
        for (std::size_t i = range.begin(); i != range.end() && i < first; ++i)
          if (bad(i)) return i;
        return first;
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
}

void check_mesh(const SurfaceMesh& mesh, std::size_t number) {
  if (mesh.positions.size() > kMaxIndex || mesh.triangles.size() > kMaxIndex / 3)
    throw BadConfiguration({"", "",
                            fmt::format("a mesh has {} positions and {} triangles", mesh.positions.size(),
                                        mesh.triangles.size()),
                            "at most 2^32-1 and (2^32-1)/3"});
  const std::size_t triangle = find_first(mesh.triangles.size(), [&](std::size_t t) {
    return std::ranges::any_of(mesh.triangles[t],
                               [&](std::uint32_t v) { return v >= mesh.positions.size(); });
  });
  if (triangle != kNotFound)
    throw BadConfiguration(fmt::format("mesh {}, triangle {}: index {}, expected less than its {} positions",
                                       number, triangle, std::ranges::max(mesh.triangles[triangle]),
                                       mesh.positions.size()));
  const std::size_t position = find_first(mesh.positions.size(), [&](std::size_t p) {
    return !std::ranges::all_of(mesh.positions[p], [](float x) { return std::isfinite(x); });
  });
  if (position != kNotFound) {
    const Float3& p = mesh.positions[position];
    throw BadConfiguration(fmt::format("mesh {}, position {}: ({}, {}, {}), expected finite numbers", number,
                                       position, p[0], p[1], p[2]));
  }
}

}  // namespace

void check_gate_options(const GateOptions& options) {
  require(options.features >= 1 && options.features <= 16, "features", options.features, "1 to 16");
  require(!options.stack.empty() && options.stack.size() <= kMaxStack, "stack", options.stack.size(),
          "1 to 4 levels");
  for (const std::uint32_t level : options.stack)
    require(is_adaptive(level) ? adaptive_divisor(level) <= kMaxAdaptiveDivisor : level <= kMaxResolution,
            "stack", level_text(level), "adaptive, a resolution or a divisor of at most 64");
  require_positive("node-spacing", options.node_spacing);
  require_positive("resolution-scale", options.resolution_scale);
  require(options.fixed_resolution >= 1 && options.fixed_resolution <= kMaxResolution, "resolution",
          options.fixed_resolution, "1 to 64");
  require(options.max_resolution >= 1 && options.max_resolution <= kMaxResolution, "max-resolution",
          options.max_resolution, "1 to 64");
  require(options.bytes_per_feature == 2 || options.bytes_per_feature == 4, "bytes-per-feature",
          options.bytes_per_feature, "2 or 4");
}

void check_surfaces(const SurfaceLayout& surfaces) {
  for (std::size_t i = 0; i < surfaces.instances.size(); ++i) {
    const SurfaceInstance& instance = surfaces.instances[i];
    if (instance.mesh >= surfaces.meshes.size())
      throw BadConfiguration(fmt::format("instance {}: mesh {}, expected less than the {} meshes", i,
                                         instance.mesh, surfaces.meshes.size()));
    if (static_cast<std::uint8_t>(instance.sides) > static_cast<std::uint8_t>(Sides::both))
      throw BadConfiguration(
          fmt::format("instance {}: sides {}, expected 0 to 3", i, static_cast<int>(instance.sides)));
    if (!(instance.spacing_scale > 0.0f) || !std::isfinite(instance.spacing_scale))
      throw BadConfiguration(fmt::format("instance {}: spacing scale {}, expected a positive number", i,
                                         instance.spacing_scale));
    if (instance.sides == Sides::none) continue;
    for (const float x : instance.object_to_world)
      if (!std::isfinite(x))
        throw BadConfiguration(
            fmt::format("instance {}: {} in its transform, expected finite numbers", i, x));
  }
  // The first wrong mesh is reported, independent of the schedule.
  std::vector<std::string> messages(surfaces.meshes.size());
  for_each(surfaces.meshes.size(), [&](std::size_t m) {
    try {
      check_mesh(surfaces.meshes[m], m);
    } catch (const BadConfiguration& error) {
      messages[m] = error.what();
    }
  });
  for (const std::string& message : messages)
    if (!message.empty()) throw BadConfiguration(message);
}

std::string level_text(std::uint32_t level) {
  if (!is_adaptive(level)) return fmt::format("{}", level);
  const std::uint32_t divisor = adaptive_divisor(level);
  return divisor == 1 ? "adaptive" : fmt::format("adaptive/{}", divisor);
}

std::string stack_text(const std::vector<std::uint32_t>& stack) {
  std::string text;
  for (const std::uint32_t level : stack) text += (text.empty() ? "" : ",") + level_text(level);
  return text;
}

}  // namespace gatelight::neural

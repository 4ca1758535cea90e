#include "neural/layout/resolution.h"

#include <algorithm>
#include <cmath>

namespace gatelight::neural {

namespace {

/// Limits an instance with large and small triangles to eight nodes in a square of the spacing: small
/// triangles get the R that the large ones need.
constexpr double kGreatestWaste = 16.0;

}  // namespace

std::vector<double> resolution_sizes(ResolutionRule rule, std::span<const SurfaceAreas> areas) {
  std::vector<double> sizes(areas.size(), 0.0);
  double greatest = 0.0;
  for (const SurfaceAreas& a : areas) greatest = std::max(greatest, a.mean());
  for (std::size_t i = 0; i < areas.size(); ++i) {
    if (areas[i].count == 0) continue;
    if (rule == ResolutionRule::uniform)
      sizes[i] = std::sqrt(std::min(areas[i].weighted_mean(), kGreatestWaste * areas[i].mean()));
    if (rule == ResolutionRule::paper) {
      const double normalized = areas[i].mean() / greatest;
      sizes[i] = 32.0 * normalized * normalized;  // clamp(32 A^2 scale, 1, 32)
    }
  }
  return sizes;
}

std::uint32_t adaptive_resolution(const GateOptions& options, double size, double node_spacing,
                                  float resolution_scale) {
  if (options.rule == ResolutionRule::fixed) return options.fixed_resolution;
  const double r = options.rule == ResolutionRule::uniform ? size / node_spacing : size * resolution_scale;
  return static_cast<std::uint32_t>(
      std::clamp(std::round(r), 1.0, static_cast<double>(options.max_resolution)));
}

std::uint32_t level_resolution(std::uint32_t level, std::uint32_t adaptive) {
  if (!is_adaptive(level)) return level;
  const std::uint32_t divisor = adaptive_divisor(level);
  return std::max(1u, (adaptive + divisor / 2) / divisor);
}

}  // namespace gatelight::neural

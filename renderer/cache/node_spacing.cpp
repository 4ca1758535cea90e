#include "renderer/cache/node_spacing.h"

#include <algorithm>
#include <cmath>

namespace gatelight::renderer {
namespace {

/// Bounds of the scales: an instance at a hundredth of the typical distance, and one at eight times that.
constexpr int kMinExponent = -7;
constexpr int kGreatestExponent = 3;

/// Largest number of nodes of an instance for each point on it. This is a hundred times what a wholly visible
/// instance needs; it keeps a facade beside the camera from taking all memory.
constexpr double kMaxNodes = 3.0;

/// The median of the values; zero where there are none.
float median(std::vector<float> values) {
  if (values.empty()) return 0.0f;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool is_width(float width) {
  return width > 0.0f && std::isfinite(width);
}

}  // namespace

NodeSpacing PixelWidths::spacing(float pixels, std::span<const double> areas) const {
  std::vector<float> all;
  for (const auto* widths : {&camera_, &bounce_}) {
    for (const std::vector<float>& of_instance : *widths)
      all.insert(all.end(), of_instance.begin(), of_instance.end());
    if (!all.empty()) break;
  }
  NodeSpacing result;
  result.scales.assign(camera_.size(), 1.0f);
  const float typical = median(std::move(all));
  if (!is_width(typical)) return result;
  result.spacing = pixels * typical;
  for (std::size_t i = 0; i < camera_.size(); ++i) {
    const std::vector<float>& points = camera_[i].empty() ? bounce_[i] : camera_[i];
    const float width = median(points);
    if (!is_width(width)) continue;
    const double least = std::sqrt(areas[i] / (kMaxNodes * static_cast<double>(points.size())));
    const double wanted = std::max(static_cast<double>(pixels * width), least);
    const auto exponent =
        static_cast<int>(std::lround(std::log2(wanted / static_cast<double>(result.spacing))));
    result.scales[i] = std::ldexp(1.0f, std::clamp(exponent, kMinExponent, kGreatestExponent));
  }
  return result;
}

}  // namespace gatelight::renderer

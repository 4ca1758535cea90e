#include "renderer/cache/node_spacing.h"

#include <algorithm>
#include <cmath>

namespace gatelight::renderer {
namespace {

/// Of scales: something a hundredth as far as the rest, something eight times as far.
constexpr int kLeastExponent = -7;
constexpr int kGreatestExponent = 3;

/// Zero of nothing.
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

NodeSpacing PixelWidths::spacing(float pixels) const {
  std::vector<float> all;
  for (const auto* widths : {&seen_, &met_}) {
    for (const std::vector<float>& of_instance : *widths)
      all.insert(all.end(), of_instance.begin(), of_instance.end());
    if (!all.empty()) break;
  }
  NodeSpacing result;
  result.scales.assign(seen_.size(), 1.0f);
  const float typical = median(std::move(all));
  if (!is_width(typical)) return result;
  result.spacing = pixels * typical;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const float width = median(seen_[i].empty() ? met_[i] : seen_[i]);
    if (!is_width(width)) continue;
    const auto exponent = static_cast<int>(std::lround(std::log2(width / typical)));
    result.scales[i] = std::ldexp(1.0f, std::clamp(exponent, kLeastExponent, kGreatestExponent));
  }
  return result;
}

}  // namespace gatelight::renderer

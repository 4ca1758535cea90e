#include "renderer/image/auto_exposure.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/math.h"

namespace gatelight::renderer {

float auto_exposure(const Picture& picture) {
  return exposure_of_light(picture).value_or(0.0f);
}

std::optional<float> exposure_of_light(const Picture& picture) {
  constexpr double kGrey = 0.18;
  /// The luminance that a share of the pixels does not exceed, and its upper bound after exposure: sunlit
  /// floors just below white without a curve, windows within the range of AgX, whose white is at 16.
  struct Bound {
    double share;
    double greatest;
  };
  constexpr Bound kBounds[] = {{0.88, 0.75}, {0.98, 12.0}};
  const Layer& beauty = picture.layers.front();
  const std::size_t channels = beauty.channels.size();
  std::vector<float> lit;
  double logs = 0.0;
  for (std::size_t i = 0; i + channels <= beauty.values.size(); i += channels) {
    const float* v = &beauty.values[i];
    const float y = channels < 3 ? v[0] : luminance(Color(v[0], v[1], v[2]));
    if (!(y > 1e-6f) || !std::isfinite(y)) continue;
    lit.push_back(y);
    logs += std::log(static_cast<double>(y));
  }
  if (lit.empty()) return std::nullopt;
  const double average = std::exp(logs / static_cast<double>(lit.size()));
  double stops = std::log2(kGrey / average);
  for (const auto& [share, greatest] : kBounds) {
    const auto at = lit.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(lit.size() - 1));
    std::nth_element(lit.begin(), at, lit.end());
    stops = std::min(stops, std::log2(greatest / static_cast<double>(*at)));
  }
  return static_cast<float>(std::round(10.0 * stops) / 10.0);
}

}  // namespace gatelight::renderer

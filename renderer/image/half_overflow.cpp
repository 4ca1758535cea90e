#include "renderer/image/half_overflow.h"

#include <algorithm>
#include <cmath>

#include "base/half.h"

namespace gatelight::renderer {

std::vector<HalfOverflow> half_overflows(const Picture& picture) {
  std::vector<HalfOverflow> found;
  for (const Layer& layer : picture.layers) {
    if (layer.full_precision) continue;
    const auto overflows = [](float x) { return std::isfinite(x) && std::abs(x) > kMaxHalf; };
    const auto count = std::count_if(layer.values.begin(), layer.values.end(), overflows);
    if (count > 0) found.push_back({layer.name, static_cast<std::size_t>(count)});
  }
  return found;
}

}  // namespace gatelight::renderer

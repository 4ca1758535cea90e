#include "renderer/film/sample_density.h"

#include <algorithm>
#include <utility>

#include "renderer/surface/ray.h"

namespace gatelight::renderer {

SampleDensity::SampleDensity(const PixelRect& rect, std::array<std::vector<float>, 2> values)
    : rect_(rect), values_(std::move(values)) {
  for (std::vector<float>& half : values_) {
    double sum = 0.0;
    for (const float v : half) sum += static_cast<double>(v);
    const double scale = sum > 0.0 ? static_cast<double>(half.size()) / sum : 0.0;
    for (float& v : half)
      v = sum > 0.0 ? std::min(static_cast<float>(static_cast<double>(v) * scale), kMost) : 1.0f;
  }
}

SampleDensity SampleDensity::restore(const PixelRect& rect, std::array<std::vector<float>, 2> values) {
  SampleDensity density;
  density.rect_ = rect;
  density.values_ = std::move(values);
  return density;
}

std::uint32_t SampleDensity::count(const Pixel& p, std::size_t half, std::uint64_t pass) const {
  const std::size_t at = rect_.index(p.x, p.y);
  const std::uint32_t h = hash(hash(static_cast<std::uint32_t>(p.x)) + static_cast<std::uint32_t>(p.y));
  // The halves take turns.
  const double begin = static_cast<double>(h) * 0x1p-32 + 0.5 * static_cast<double>(half);
  const double each = 0.5 * static_cast<double>(values_[half][at]);
  const auto until = [&](std::uint64_t passes) {
    return static_cast<std::uint64_t>(begin + each * static_cast<double>(passes));
  };
  return static_cast<std::uint32_t>(until(pass + 1) - until(pass));
}

}  // namespace gatelight::renderer

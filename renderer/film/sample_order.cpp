#include "renderer/film/sample_order.h"

#include <cmath>
#include <numeric>

namespace gatelight::renderer {
namespace {

/// The inverse of the plastic number's square, and the inverse of the plastic number.
constexpr double kRowStep = 0.5698402909980532;
constexpr double kColumnStep = 0.7548776662466927;

}  // namespace

SampleOrder::SampleOrder(const PixelRect& region) : region_(region) {
  const auto width = static_cast<std::uint64_t>(region.width());
  const auto height = static_cast<std::uint64_t>(region.height());
  pixels_ = width * height;
  step_ = static_cast<std::uint64_t>(std::llround(kRowStep * static_cast<double>(height))) * width +
          static_cast<std::uint64_t>(std::llround(kColumnStep * static_cast<double>(width)));
  while (std::gcd(step_, pixels_) != 1) ++step_;
}

PixelSample SampleOrder::at(std::uint64_t index) const {
  // Pictures have less than 2^32 pixels, so the product fits.
  const std::uint64_t place = index % pixels_ * (step_ % pixels_) % pixels_;
  const auto width = static_cast<std::uint64_t>(region_.width());
  return {{region_.x0 + static_cast<int>(place % width), region_.y0 + static_cast<int>(place / width)},
          static_cast<std::uint32_t>(index / pixels_)};
}

}  // namespace gatelight::renderer

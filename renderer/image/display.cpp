#include "renderer/image/display.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "base/parallel/loops.h"
#include "renderer/image/image_library.h"
#include "renderer/image/white_balance.h"

namespace gatelight::renderer {
namespace {

constexpr std::size_t kPixelsOfTask = 1024;  // of 0.1 microseconds or more

}  // namespace

std::vector<float> displayed(const Picture& picture, const DisplayOptions& options) {
  const Layer& beauty = picture.layers.front();
  const std::size_t channels = beauty.channels.size();
  const bool with_alpha = beauty.has_alpha();
  const std::size_t colors = with_alpha ? channels - 1 : channels, shown = with_alpha ? 4 : 3;
  const std::size_t pixels = beauty.values.size() / channels;
  const Eigen::Matrix3f balance = white_balance(options.white_balance) * exposure_scale(options.exposure);
  const bool balanced = options.white_balance != kDaylightKelvin;
  const bool by_ocio = !options.ocio.config.empty();
  std::vector<float> rgb(3 * pixels), result(with_alpha ? shown * pixels : 0);
  const auto show = [&](std::size_t p) {
    const float* const value = &beauty.values[p * channels];
    const float alpha = with_alpha ? std::clamp(value[colors], 0.0f, 1.0f) : 1.0f;
    Color color;
    for (std::size_t c = 0; c < 3; ++c) {
      const float v = value[std::min(c, colors - 1)];
      color[static_cast<Eigen::Index>(c)] = alpha > 0.0f ? v / alpha : 0.0f;
    }
    color = balanced ? Color((balance * color.matrix()).array()) : color * balance(0, 0);
    if (!by_ocio) color = display_color(color, options.tonemap);
    for (std::size_t c = 0; c < 3; ++c) rgb[3 * p + c] = color[static_cast<Eigen::Index>(c)];
    if (with_alpha) result[shown * p + 3] = alpha;
  };
  for_each_range(pixels, kPixelsOfTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) show(p);
  });
  if (by_ocio) image_library().show(rgb, options.ocio);
  if (!with_alpha) return rgb;
  for (std::size_t p = 0; p < pixels; ++p) std::copy_n(&rgb[3 * p], 3, &result[shown * p]);
  return result;
}

void check_display(const DisplayOptions& options) {
  if (options.ocio.config.empty()) return;
  std::vector<float> grey(3, 0.18f);
  image_library().show(grey, options.ocio);
}

}  // namespace gatelight::renderer

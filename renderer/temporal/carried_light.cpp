#include "renderer/temporal/carried_light.h"

#include <algorithm>
#include <cmath>

#include "base/parallel/loops.h"
#include "renderer/image/box_filter.h"

namespace gatelight::renderer {
namespace {

/// Colours of surfaces below this are not divided out.
constexpr float kDarkest = 0.02f;
/// Pixels around, in each direction, whose light is compared; its difference is allowed to be so many
/// standard errors and a share of the light, and twice of both is too much.
constexpr int kAround = 4;
constexpr float kStandardErrors = 2.0f;
/// Pixels around, in each direction, whose samples decide how bright the carried light is.
constexpr int kAroundMatch = 24;
/// Finer light than kAroundLow is mixed in by at most this share.
constexpr float kMaxHigh = 0.5f;

template <class Function>
void for_each_pixel(std::size_t pixels, const Function& function) {
  for_each_range(pixels, 1 << 12, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) function(i);
  });
}

}  // namespace

float light_divisor(float albedo) {
  return albedo > kDarkest ? albedo : 1.0f;
}

float light_of(const float* color, const float* albedo) {
  return luminance(Color(color[0] / light_divisor(albedo[0]), color[1] / light_divisor(albedo[1]),
                         color[2] / light_divisor(albedo[2])));
}

void compare_samples(const FrameSamples& frame, std::vector<ReprojectedSample>& carried,
                     float allowed_share) {
  const std::size_t pixels = carried.size();
  std::vector<float> there(pixels), now(pixels), before(pixels), variance(pixels);
  for_each_pixel(pixels, [&](std::size_t i) {
    if (!(carried[i].samples > 0.0f)) return;
    there[i] = 1.0f;
    now[i] = light_of(&frame.color[3 * i], &frame.albedo[3 * i]);
    before[i] = light_of(carried[i].color.data(), &frame.albedo[3 * i]);
    variance[i] = frame.variance[i] * (1.0f + frame.count[i] / carried[i].samples);
  });
  for (std::vector<float>* plane : {&there, &now, &before, &variance})
    box_filter(*plane, frame.rect.width(), frame.rect.height(), kAround);
  constexpr float kArea = (2 * kAround + 1) * (2 * kAround + 1);
  for_each_pixel(pixels, [&](std::size_t i) {
    if (!(carried[i].samples > 0.0f)) return;
    const float pixels_there = there[i] * kArea;
    const float difference = std::abs(now[i] - before[i]) / there[i];
    const float noise = std::sqrt(variance[i] / there[i] / pixels_there);
    const float allowed = kStandardErrors * noise + allowed_share * std::max(now[i], before[i]) / there[i];
    const float excess = allowed > 0.0f ? difference / allowed : 0.0f;
    carried[i].samples *= std::clamp(2.0f - excess, 0.0f, 1.0f);
  });
}

void match_brightness(const FrameSamples& frame, std::vector<ReprojectedSample>& carried) {
  const std::size_t pixels = carried.size();
  std::vector<float> there(pixels), ratio(pixels), variance(pixels);
  for_each_pixel(pixels, [&](std::size_t i) {
    const float before = luminance(carried[i].color);
    if (!(carried[i].samples > 0.0f) || !(before > 0.0f)) return;
    there[i] = 1.0f;
    ratio[i] = luminance(Color(frame.color[3 * i], frame.color[3 * i + 1], frame.color[3 * i + 2])) / before;
    const float light = light_of(carried[i].color.data(), &frame.albedo[3 * i]);
    variance[i] = frame.variance[i] / (light * light);
  });
  for (std::vector<float>* plane : {&there, &ratio, &variance})
    box_filter(*plane, frame.rect.width(), frame.rect.height(), kAroundMatch);
  constexpr float kArea = (2 * kAroundMatch + 1) * (2 * kAroundMatch + 1);
  for_each_pixel(pixels, [&](std::size_t i) {
    if (!(carried[i].samples > 0.0f) || !(there[i] > 0.0f)) return;
    const float difference = ratio[i] / there[i] - 1.0f;
    const float noise = variance[i] / there[i] / (there[i] * kArea);
    const float known = std::max(difference * difference - kStandardErrors * kStandardErrors * noise, 0.0f);
    const float share = known > 0.0f ? known / (known + noise) : 0.0f;
    carried[i].color *= std::clamp(1.0f + share * difference, 1.0f / kMaxRatio, kMaxRatio);
  });
}

CarriedLight with_carried(const FrameSamples& frame, const std::vector<ReprojectedSample>& carried,
                          const std::vector<float>& edges) {
  const std::size_t pixels = carried.size();
  CarriedLight result;
  result.color.resize(3 * pixels);
  result.weight.resize(pixels);
  result.samples.resize(pixels);
  for_each_pixel(pixels, [&](std::size_t i) {
    result.samples[i] = edges[i] > 0.0f ? 0.0f : frame.count[i] + carried[i].samples;
    if (!(carried[i].samples > 0.0f)) return;
    result.weight[i] = carried[i].samples / result.samples[i];
    std::copy_n(carried[i].color.data(), 3, &result.color[3 * i]);
  });
  const auto taken =
      std::count_if(result.weight.begin(), result.weight.end(), [](float w) { return w > 0.0f; });
  result.share = static_cast<double>(taken) / static_cast<double>(std::max<std::size_t>(pixels, 1));
  return result;
}

void mix_light(const CarriedLight& carried, const PixelRect& rect, std::vector<float>& denoised) {
  if (carried.color.empty()) return;
  const std::size_t pixels = carried.weight.size();
  const auto mean_around = [&](std::vector<float>& plane) {
    box_filter(plane, rect.width(), rect.height(), kAroundLow);
  };
  std::vector<float> weight = carried.weight, there(pixels);
  for (std::size_t i = 0; i < pixels; ++i) there[i] = weight[i] > 0.0f ? 1.0f : 0.0f;
  mean_around(weight);
  mean_around(there);
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<float> before(pixels), now(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
      if (!(carried.weight[i] > 0.0f)) continue;
      before[i] = carried.color[3 * i + c];
      now[i] = denoised[3 * i + c];
    }
    mean_around(before);
    mean_around(now);
    for (std::size_t i = 0; i < pixels; ++i) {
      if (!(there[i] > 0.0f) || !(now[i] > 0.0f)) continue;
      const float ratio = std::clamp(before[i] / now[i], 1.0f / kMaxRatio, kMaxRatio);
      float& color = denoised[3 * i + c];
      const float as_bright = color * ratio, low = weight[i] / there[i];
      const float high = std::min(carried.weight[i], kMaxHigh);
      color += low * (as_bright - color);
      if (high > 0.0f) color += high * (carried.color[3 * i + c] - as_bright);
      color = std::max(color, 0.0f);
    }
  }
}

}  // namespace gatelight::renderer

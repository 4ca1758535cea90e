#include "renderer/reuse/picture_history.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel/loops.h"
#include "renderer/image/box_filter.h"

namespace gatelight::renderer {
namespace {

/// Greatest second difference of the inverse of depth over one pixel, in shares of it: it is 0 on a plane.
constexpr float kMostBend = 0.02f;
/// Greatest change of depth from one frame to the next.
constexpr float kMostDepth = 0.1f;
/// The albedo is the same up to the first difference, and another from the second on.
constexpr float kSameAlbedo = 0.05f, kOtherAlbedo = 0.2f;
/// A change of light by this share counts as none. No probes tell that a shadow has moved.
constexpr float kAllowedShare = 0.01f;

class PictureCarrier {
 public:
  PictureCarrier(const FrameLayers& frame, const std::vector<float>& denoised, const PictureHistory* history)
      : frame_(frame), history_(history) {
    const std::size_t pixels = frame.color.size() / 3;
    carried_.resize(pixels);
    edges_.resize(pixels);
    samples_.rect = frame.rect;
    samples_.color = frame.color;
    samples_.albedo = frame.albedo.empty() ? std::vector<float>(3 * pixels) : frame.albedo;
    samples_.count.assign(pixels, 1.0f);
    samples_.variance.resize(pixels);
    for_each_pixel([&](std::size_t i) {
      // The mean over some pixels is about the variance.
      const float noise = light_of(&frame_.color[3 * i], &samples_.albedo[3 * i]) -
                          light_of(&denoised[3 * i], &samples_.albedo[3 * i]);
      samples_.variance[i] = noise * noise;
    });
  }

  CarriedLight run() {
    for_each_pixel([&](std::size_t i) { edges_[i] = is_edge(i) ? 1.0f : 0.0f; });
    box_filter(edges_, frame_.rect.width(), frame_.rect.height(), kAroundEdge);
    if (history_ && !frame_.motion.empty()) {
      for_each_pixel([&](std::size_t i) {
        if (!(edges_[i] > 0.0f)) carried_[i] = carry(i);
      });
      compare_samples(samples_, carried_, kAllowedShare);
    }
    return with_carried(samples_, carried_, edges_);
  }

 private:
  template <class Function>
  void for_each_pixel(const Function& function) const {
    for_each_range(edges_.size(), 1 << 12, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) function(i);
    });
  }

  /// Whether normals are those of one surface, as far as there are normals.
  static bool same_normal(const std::vector<float>& a, std::size_t i, const std::vector<float>& b,
                          std::size_t j) {
    if (a.empty() || b.empty()) return true;
    const Vec3 n(a[3 * i], a[3 * i + 1], a[3 * i + 2]), m(b[3 * j], b[3 * j + 1], b[3 * j + 2]);
    const float lengths = n.norm() * m.norm();
    return lengths > 0.0f ? n.dot(m) >= kLeastCosine * lengths : n.isZero() && m.isZero();
  }

  /// The inverse of the depth; 0 for the background, which programs put at various great depths.
  static float nearness(const std::vector<float>& depth, std::size_t i) {
    constexpr float kBackground = 1e9f;
    return depth[i] > 0.0f && depth[i] < kBackground ? 1.0f / depth[i] : 0.0f;
  }

  bool differs(std::size_t i, std::size_t j) const {
    if (!frame_.object.empty() && frame_.object[i] != frame_.object[j]) return true;
    return !same_normal(frame_.normal, i, frame_.normal, j);
  }

  /// Whether the depth bends between two neighbours of a pixel.
  bool bends(std::size_t before, std::size_t i, std::size_t after) const {
    if (frame_.depth.empty()) return false;
    const float at = nearness(frame_.depth, i), a = nearness(frame_.depth, before),
                b = nearness(frame_.depth, after);
    return std::abs(a - 2.0f * at + b) > kMostBend * std::max({a, at, b});
  }

  bool is_edge(std::size_t i) const {
    const auto width = static_cast<std::size_t>(frame_.rect.width());
    const std::size_t x = i % width;
    const bool left = x > 0, right = x + 1 < width, above = i >= width, below = i + width < edges_.size();
    return (left && differs(i, i - 1)) || (right && differs(i, i + 1)) || (above && differs(i, i - width)) ||
           (below && differs(i, i + width)) || (left && right && bends(i - 1, i, i + 1)) ||
           (above && below && bends(i - width, i, i + width));
  }

  bool same_surface(std::size_t i, std::size_t there) const {
    const FrameLayers& before = history_->layers;
    if (!frame_.object.empty() && !before.object.empty() && frame_.object[i] != before.object[there])
      return false;
    if (!same_normal(frame_.normal, i, before.normal, there)) return false;
    if (frame_.depth.empty() || before.depth.empty()) return true;
    const float a = nearness(frame_.depth, i), b = nearness(before.depth, there);
    return std::abs(a - b) <= kMostDepth * std::max(a, b);
  }

  /// How far an albedo is still the same.
  float same_albedo(std::size_t i, const Color& before) const {
    if (frame_.albedo.empty() || history_->layers.albedo.empty()) return 1.0f;
    const Color now(frame_.albedo[3 * i], frame_.albedo[3 * i + 1], frame_.albedo[3 * i + 2]);
    const float difference = (now - before).abs().maxCoeff();
    return std::clamp((kOtherAlbedo - difference) / (kOtherAlbedo - kSameAlbedo), 0.0f, 1.0f);
  }

  /// The mean of the four pixels around the earlier place, of those that show the same surface.
  Carried carry(std::size_t i) const {
    const auto width = static_cast<std::size_t>(frame_.rect.width());
    const float x = static_cast<float>(frame_.rect.x0) + static_cast<float>(i % width) - frame_.motion[2 * i];
    const float y =
        static_cast<float>(frame_.rect.y0) + static_cast<float>(i / width) + frame_.motion[2 * i + 1];
    const PixelRect& r = history_->layers.rect;
    const float left = std::floor(x), top = std::floor(y), u = x - left, v = y - top;
    Carried sum;
    Color albedo = Color::Zero();
    float weights = 0.0f;
    for (int k = 0; k < 4; ++k) {
      const float px = left + static_cast<float>(k & 1), py = top + static_cast<float>(k >> 1);
      if (!(px >= static_cast<float>(r.x0) && px < static_cast<float>(r.x1) &&
            py >= static_cast<float>(r.y0) && py < static_cast<float>(r.y1)))
        continue;
      const std::size_t there = r.index(static_cast<int>(px), static_cast<int>(py));
      if (!(history_->samples[there] > 0.0f) || !same_surface(i, there)) continue;
      const float weight = ((k & 1) != 0 ? u : 1.0f - u) * ((k >> 1) != 0 ? v : 1.0f - v);
      weights += weight;
      sum.samples += weight * history_->samples[there];
      const auto add = [&](Color& to, const std::vector<float>& plane) {
        if (!plane.empty())
          to += weight * Color(plane[3 * there], plane[3 * there + 1], plane[3 * there + 2]);
      };
      add(sum.color, history_->color);
      add(albedo, history_->layers.albedo);
    }
    if (!(weights > 0.01f)) return {};
    sum.color /= weights;
    sum.samples = std::min(sum.samples, kMostEarlier) * weights * same_albedo(i, albedo / weights);
    return sum;
  }

  const FrameLayers& frame_;
  const PictureHistory* history_;  ///< null: there is none
  FrameSamples samples_;
  std::vector<float> edges_;
  std::vector<Carried> carried_;
};

}  // namespace

CarriedLight carry_picture(const FrameLayers& frame, const std::vector<float>& denoised,
                           const PictureHistory* history) {
  CarriedLight carried = PictureCarrier(frame, denoised, history).run();
  if (!history) carried.color.clear();
  return carried;
}

}  // namespace gatelight::renderer

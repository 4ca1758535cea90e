#include "renderer/reuse/history.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/parallel/loops.h"
#include "renderer/image/box_filter.h"

namespace gatelight::renderer {
namespace {

/// Colours of surfaces below this are not divided out.
constexpr float kDarkest = 0.02f;
/// The earlier point of a pixel lies near the present one: in normal direction at most this many pixels away,
/// along the surface this many.
constexpr float kMostAcross = 1.0f, kMostAlong = 3.0f;
constexpr float kLeastCosine = 0.9f;
/// Pixels so near an edge, in each direction, mix the light of surfaces: filters of pixels and the denoiser
/// reach as far. What they show is not carried. A dark arch before a sunlit wall would grow brighter as it
/// comes nearer.
constexpr int kAroundEdge = 2;
/// Pixels around, in each direction, whose probes are compared. Their light is the same up to the first
/// relative change, and another from the second on.
constexpr int kAroundProbe = 2;
constexpr float kUnchanged = 0.03f, kChanged = 0.2f;
/// Pixels around, in each direction, whose light is compared; its difference is allowed to be so many
/// standard errors and this share of the light, and twice of both is too much.
constexpr int kAround = 4;
constexpr float kStandardErrors = 2.0f, kAllowed = 0.05f;
/// Pixels around, in each direction, whose samples decide how bright the carried light is.
constexpr int kAroundMatch = 24;
/// The carried light is mixed in by its full share in means over so many pixels around, in each direction; by
/// at most this share in what is finer.
constexpr int kAroundLow = 4;
constexpr float kMostHigh = 0.5f;
/// Most change of these means.
constexpr float kMostRatio = 2.0f;

float factor(float albedo) {
  return albedo > kDarkest ? albedo : 1.0f;
}

/// Luminance of the light on a surface.
float light_of(const float* color, const float* albedo) {
  return luminance(
      Color(color[0] / factor(albedo[0]), color[1] / factor(albedo[1]), color[2] / factor(albedo[2])));
}

bool same_surface(const VisiblePoint& there, const VisiblePoint& now, const EarlierPoint& earlier) {
  if (!there.hit || there.hit.instance != now.hit.instance) return false;
  if (there.normal.dot(earlier.normal) < kLeastCosine) return false;
  const Vec3 apart = there.position - earlier.position;
  const float width = std::max(there.width, now.width);
  const float across = std::abs(apart.dot(earlier.normal));
  // A pixel is longer on a surface that is seen from the side.
  return across <= kMostAcross * width &&
         apart.squaredNorm() <= 400.0f * kMostAlong * kMostAlong * width * width;
}

/// How far the light still holds that depends on the view.
float same_gloss(const VisiblePoint& now, const EarlierPoint& earlier) {
  const float turned = (now.reflected - earlier.reflected).norm() / now.lobe;
  return 1.0f - now.glossy * (1.0f - std::exp(-turned * turned));
}

/// What a pixel may take over.
struct Carried {
  Color color{0.0f, 0.0f, 0.0f};
  float samples = 0.0f;
  float probe = 0.0f;
};

class Carrier {
 public:
  Carrier(const Film& film, const VisiblePoints& points, const std::vector<float>& probes,
          const History* history)
      : rect_(film.rect()),
        points_(points),
        probes_(probes),
        history_(history),
        color_(film.plane(Plane::mean, rect_.y0, rect_.y1)),
        albedo_(film.plane(Plane::albedo, rect_.y0, rect_.y1)),
        film_(film),
        carried_(film.pixels()) {}

  Reuse run() {
    edges_.resize(carried_.size());
    for_each_pixel([&](std::size_t i) { edges_[i] = is_edge(i) ? 1.0f : 0.0f; });
    box_filter(edges_, rect_.width(), rect_.height(), kAroundEdge);
    if (history_) {
      carry();
      if (!probes_.empty() && !history_->probes.empty()) compare_probes();
      compare_samples();
      match_brightness();
    }
    return result();
  }

 private:
  template <class Function>
  void for_each_pixel(const Function& function) const {
    for_each(static_cast<std::size_t>(rect_.height()), [&](std::size_t row) {
      const std::size_t first = row * static_cast<std::size_t>(rect_.width());
      for (int x = 0; x < rect_.width(); ++x) function(first + static_cast<std::size_t>(x));
    });
  }

  /// The mean of the four pixels around the earlier point, of those that show its surface.
  void carry() {
    for_each_pixel([&](std::size_t i) {
      if (points_.now[i].hit && points_.earlier[i] && !(edges_[i] > 0.0f)) carried_[i] = carry(i);
    });
  }

  Carried carry(std::size_t i) const {
    const VisiblePoint& now = points_.now[i];
    const EarlierPoint& earlier = *points_.earlier[i];
    const float x = earlier.pixel.x() - 0.5f, y = earlier.pixel.y() - 0.5f;
    const float left = std::floor(x), top = std::floor(y), u = x - left, v = y - top;
    const PixelRect& r = history_->rect;
    Carried sum;
    float weights = 0.0f;
    for (int k = 0; k < 4; ++k) {
      const float px = left + static_cast<float>(k & 1), py = top + static_cast<float>(k >> 1);
      if (!(px >= static_cast<float>(r.x0) && px < static_cast<float>(r.x1) &&
            py >= static_cast<float>(r.y0) && py < static_cast<float>(r.y1)))
        continue;
      const std::size_t there = r.index(static_cast<int>(px), static_cast<int>(py));
      if (!(history_->samples[there] > 0.0f) || !same_surface(history_->points[there], now, earlier))
        continue;
      const float weight = ((k & 1) != 0 ? u : 1.0f - u) * ((k >> 1) != 0 ? v : 1.0f - v);
      weights += weight;
      sum.samples += weight * history_->samples[there];
      if (!history_->probes.empty()) sum.probe += weight * history_->probes[there];
      for (std::size_t c = 0; c < 3; ++c)
        sum.color[static_cast<Eigen::Index>(c)] += weight * history_->color[3 * there + c];
    }
    if (!(weights > 0.01f)) return {};
    sum.color /= weights;
    sum.samples = std::min(sum.samples, kMostEarlier * samples(i)) * weights * same_gloss(now, earlier);
    sum.probe /= weights;
    return sum;
  }

  /// Whether the pixel shows parts of several surfaces.
  bool is_edge(std::size_t i) const {
    const auto width = static_cast<std::size_t>(rect_.width());
    const std::size_t x = i % width;
    const auto differs = [&](std::size_t j) {
      const VisiblePoint &a = points_.now[i], &b = points_.now[j];
      if (a.hit.instance != b.hit.instance || a.normal.dot(b.normal) < kLeastCosine) return true;
      return std::abs((a.position - b.position).dot(a.normal)) > 2.0f * a.width;
    };
    return (x > 0 && differs(i - 1)) || (x + 1 < width && differs(i + 1)) ||
           (i >= width && differs(i - width)) || (i + width < points_.now.size() && differs(i + width));
  }

  /// Takes less over where the light of the probes has changed.
  void compare_probes() {
    const std::size_t pixels = carried_.size();
    std::vector<float> difference(pixels), light(pixels);
    for_each_pixel([&](std::size_t i) {
      if (!(carried_[i].samples > 0.0f)) return;
      difference[i] = std::abs(probes_[i] - carried_[i].probe);
      light[i] = std::max(probes_[i], carried_[i].probe);
    });
    for (std::vector<float>* plane : {&difference, &light})
      box_filter(*plane, rect_.width(), rect_.height(), kAroundProbe);
    for_each_pixel([&](std::size_t i) {
      const float change = light[i] > 0.0f ? difference[i] / light[i] : 0.0f;
      carried_[i].samples *= std::clamp((kChanged - change) / (kChanged - kUnchanged), 0.0f, 1.0f);
    });
  }

  /// Takes less over where the light around has changed by more than its noise.
  void compare_samples() {
    const std::size_t pixels = carried_.size();
    std::vector<float> there(pixels), now(pixels), before(pixels), variance(pixels);
    for_each_pixel([&](std::size_t i) {
      const Carried& carried = carried_[i];
      if (!(carried.samples > 0.0f)) return;
      there[i] = 1.0f;
      now[i] = light_of(&color_[3 * i], &albedo_[3 * i]);
      before[i] = light_of(carried.color.data(), &albedo_[3 * i]);
      const float of_mean = variance_of_light(i);
      variance[i] = of_mean * (1.0f + samples(i) / carried.samples);
    });
    for (std::vector<float>* plane : {&there, &now, &before, &variance})
      box_filter(*plane, rect_.width(), rect_.height(), kAround);
    constexpr float kArea = (2 * kAround + 1) * (2 * kAround + 1);
    for_each_pixel([&](std::size_t i) {
      Carried& carried = carried_[i];
      if (!(carried.samples > 0.0f)) return;
      const float pixels_there = there[i] * kArea;
      const float difference = std::abs(now[i] - before[i]) / there[i];
      const float noise = std::sqrt(variance[i] / there[i] / pixels_there);
      const float allowed = kStandardErrors * noise + kAllowed * std::max(now[i], before[i]) / there[i];
      const float excess = allowed > 0.0f ? difference / allowed : 0.0f;
      carried.samples *= std::clamp(2.0f - excess, 0.0f, 1.0f);
    });
  }

  /// Corrects the carried light by the mean ratio of the samples to it, as far as their noise lets it be
  /// known: what a rough surface reflects changes slowly with the view.
  void match_brightness() {
    const std::size_t pixels = carried_.size();
    std::vector<float> there(pixels), ratio(pixels), variance(pixels);
    for_each_pixel([&](std::size_t i) {
      const float before = luminance(carried_[i].color);
      if (!(carried_[i].samples > 0.0f) || !(before > 0.0f)) return;
      there[i] = 1.0f;
      ratio[i] = luminance(Color(color_[3 * i], color_[3 * i + 1], color_[3 * i + 2])) / before;
      const float light = light_of(carried_[i].color.data(), &albedo_[3 * i]);
      variance[i] = variance_of_light(i) / (light * light);
    });
    for (std::vector<float>* plane : {&there, &ratio, &variance})
      box_filter(*plane, rect_.width(), rect_.height(), kAroundMatch);
    constexpr float kArea = (2 * kAroundMatch + 1) * (2 * kAroundMatch + 1);
    for_each_pixel([&](std::size_t i) {
      if (!(carried_[i].samples > 0.0f) || !(there[i] > 0.0f)) return;
      const float difference = ratio[i] / there[i] - 1.0f;
      const float noise = variance[i] / there[i] / (there[i] * kArea);
      const float known = std::max(difference * difference - kStandardErrors * kStandardErrors * noise, 0.0f);
      const float share = known > 0.0f ? known / (known + noise) : 0.0f;
      carried_[i].color *= std::clamp(1.0f + share * difference, 1.0f / kMostRatio, kMostRatio);
    });
  }

  float samples(std::size_t i) const { return static_cast<float>(film_.sums().radiance[i].count); }

  /// The variance of the mean of a pixel's luminance, without the surface's colour.
  float variance_of_light(std::size_t i) const {
    const RadianceSum& p = film_.sums().radiance[i];
    if (p.count < 2) {
      const float light = light_of(&color_[3 * i], &albedo_[3 * i]);
      return light * light;
    }
    const double n = p.count;
    Color variance;
    for (std::size_t c = 0; c < 3; ++c) {
      const double mean = p.sum[c] / n;
      const float f = factor(albedo_[3 * i + c]);
      variance[static_cast<Eigen::Index>(c)] =
          static_cast<float>(std::max(p.square[c] / n - mean * mean, 0.0) / (n - 1.0)) / (f * f);
    }
    return variance.maxCoeff();
  }

  Reuse result() const {
    const std::size_t pixels = carried_.size();
    Reuse result;
    if (history_) result.color.resize(3 * pixels);
    result.weight.resize(pixels);
    result.samples.resize(pixels);
    for_each_pixel([&](std::size_t i) {
      const Carried& carried = carried_[i];
      result.samples[i] = edges_[i] > 0.0f ? 0.0f : samples(i) + carried.samples;
      if (!(carried.samples > 0.0f)) return;
      result.weight[i] = carried.samples / result.samples[i];
      std::copy_n(carried.color.data(), 3, &result.color[3 * i]);
    });
    const auto taken =
        std::count_if(result.weight.begin(), result.weight.end(), [](float w) { return w > 0.0f; });
    result.share = static_cast<double>(taken) / static_cast<double>(std::max<std::size_t>(pixels, 1));
    return result;
  }

  PixelRect rect_;
  const VisiblePoints& points_;
  const std::vector<float>& probes_;
  const History* history_;  ///< null: there is none
  std::vector<float> color_, albedo_, edges_;
  const Film& film_;
  std::vector<Carried> carried_;
};

}  // namespace

Reuse reuse_samples(const Film& film, VisiblePoints points, std::vector<float> probes,
                    const History* history) {
  Reuse reuse = Carrier(film, points, probes, history).run();
  reuse.points = std::move(points);
  reuse.probes = std::move(probes);
  return reuse;
}

void mix_light(const Reuse& reuse, const PixelRect& rect, std::vector<float>& denoised) {
  if (reuse.color.empty()) return;
  const std::size_t pixels = reuse.weight.size();
  const auto mean_around = [&](std::vector<float>& plane) {
    box_filter(plane, rect.width(), rect.height(), kAroundLow);
  };
  std::vector<float> weight = reuse.weight, there(pixels);
  for (std::size_t i = 0; i < pixels; ++i) there[i] = weight[i] > 0.0f ? 1.0f : 0.0f;
  mean_around(weight);
  mean_around(there);
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<float> before(pixels), now(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
      if (!(reuse.weight[i] > 0.0f)) continue;
      before[i] = reuse.color[3 * i + c];
      now[i] = denoised[3 * i + c];
    }
    mean_around(before);
    mean_around(now);
    for (std::size_t i = 0; i < pixels; ++i) {
      if (!(there[i] > 0.0f) || !(now[i] > 0.0f)) continue;
      const float ratio = std::clamp(before[i] / now[i], 1.0f / kMostRatio, kMostRatio);
      float& color = denoised[3 * i + c];
      const float as_bright = color * ratio, low = weight[i] / there[i];
      const float high = std::min(reuse.weight[i], kMostHigh);
      color += low * (as_bright - color);
      if (high > 0.0f) color += high * (reuse.color[3 * i + c] - as_bright);
      color = std::max(color, 0.0f);
    }
  }
}

}  // namespace gatelight::renderer

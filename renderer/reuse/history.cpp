#include "renderer/reuse/history.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "renderer/image/box_filter.h"

namespace gatelight::renderer {
namespace {

/// Colours of surfaces below this are not divided out.
constexpr float kDarkest = 0.02f;
/// The earlier point of a pixel lies near the present one: in normal direction at most this many pixels away,
/// along the surface this many.
constexpr float kMostAcross = 1.0f, kMostAlong = 3.0f;
constexpr float kLeastCosine = 0.9f;
/// A change of the surface's colour makes carried light at most so many times as bright: the colour of a lamp
/// says nothing about its light.
constexpr float kBrightest = 3.0f;
/// Share of what an edge takes over: the earlier picture mixes its surfaces in other parts.
constexpr float kAtEdges = 0.0f;
/// Pixels around, in each direction, whose probes are compared. Their light is the same up to the first
/// relative change, and another from the second on.
constexpr int kAroundProbe = 2;
constexpr float kUnchanged = 0.03f, kChanged = 0.2f;
/// Pixels around, in each direction, whose light is compared; its difference is allowed to be so many
/// standard errors and this share of the light, and twice of both is too much.
constexpr int kAround = 4;
constexpr float kStandardErrors = 2.0f, kAllowed = 0.05f;

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
          const History& history)
      : rect_(film.rect()),
        points_(points),
        probes_(probes),
        history_(history),
        color_(film.plane(Plane::mean, rect_.y0, rect_.y1)),
        albedo_(film.plane(Plane::albedo, rect_.y0, rect_.y1)),
        film_(film),
        carried_(film.pixels()) {}

  Reuse run() {
    carry();
    if (!probes_.empty() && !history_.probes.empty()) compare_probes();
    compare_samples();
    return blend();
  }

 private:
  template <class Function>
  void for_each_pixel(const Function& function) const {
    tbb::parallel_for(0, rect_.height(), [&](int row) {
      const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(rect_.width());
      for (int x = 0; x < rect_.width(); ++x) function(first + static_cast<std::size_t>(x));
    });
  }

  /// The mean of the four pixels around the earlier point, of those that show its surface.
  void carry() {
    for_each_pixel([&](std::size_t i) {
      if (points_.now[i].hit && points_.earlier[i]) carried_[i] = carry(i);
    });
  }

  Carried carry(std::size_t i) const {
    const VisiblePoint& now = points_.now[i];
    const EarlierPoint& earlier = *points_.earlier[i];
    const float x = earlier.pixel.x() - 0.5f, y = earlier.pixel.y() - 0.5f;
    const float left = std::floor(x), top = std::floor(y), u = x - left, v = y - top;
    const PixelRect& r = history_.rect;
    Carried sum;
    float weights = 0.0f, brightest = 0.0f;
    for (int k = 0; k < 4; ++k) {
      const float px = left + static_cast<float>(k & 1), py = top + static_cast<float>(k >> 1);
      if (!(px >= static_cast<float>(r.x0) && px < static_cast<float>(r.x1) &&
            py >= static_cast<float>(r.y0) && py < static_cast<float>(r.y1)))
        continue;
      const std::size_t there = r.index(static_cast<int>(px), static_cast<int>(py));
      if (!(history_.samples[there] > 0.0f) || !same_surface(history_.points[there], now, earlier)) continue;
      const float weight = ((k & 1) != 0 ? u : 1.0f - u) * ((k >> 1) != 0 ? v : 1.0f - v);
      weights += weight;
      const float* const color = &history_.color[3 * there];
      brightest += weight * std::max({color[0], color[1], color[2]});
      sum.samples += weight * history_.samples[there];
      if (!history_.probes.empty()) sum.probe += weight * history_.probes[there];
      for (int c = 0; c < 3; ++c) {
        const std::size_t from = 3 * there + static_cast<std::size_t>(c);
        sum.color[c] += weight * history_.color[from] / factor(history_.albedo[from]);
      }
    }
    if (!(weights > 0.01f)) return {};
    for (int c = 0; c < 3; ++c)
      sum.color[c] *= factor(albedo_[3 * i + static_cast<std::size_t>(c)]) / weights;
    sum.samples = std::min(sum.samples, kMostEarlier * samples(i)) * weights * same_gloss(now, earlier);
    if (!(sum.color.maxCoeff() <= kBrightest * brightest / weights)) return {};
    sum.probe /= weights;
    if (is_edge(i)) sum.samples *= kAtEdges;
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

  Reuse blend() const {
    Reuse result{.color = color_, .samples = std::vector<float>(carried_.size())};
    std::vector<std::uint8_t> taken(carried_.size());
    for_each_pixel([&](std::size_t i) {
      const Carried& carried = carried_[i];
      const float own = samples(i), all = own + carried.samples;
      result.samples[i] = all;
      if (!(carried.samples > 0.0f)) return;
      taken[i] = 1;
      for (int c = 0; c < 3; ++c) {
        float& color = result.color[3 * i + static_cast<std::size_t>(c)];
        color = (own * color + carried.samples * carried.color[c]) / all;
      }
    });
    result.share = static_cast<double>(std::count(taken.begin(), taken.end(), 1)) /
                   static_cast<double>(std::max<std::size_t>(taken.size(), 1));
    return result;
  }

  PixelRect rect_;
  const VisiblePoints& points_;
  const std::vector<float>& probes_;
  const History& history_;
  std::vector<float> color_, albedo_;
  const Film& film_;
  std::vector<Carried> carried_;
};

}  // namespace

Reuse reuse_samples(const Film& film, VisiblePoints points, std::vector<float> probes,
                    const History& history) {
  Reuse reuse = Carrier(film, points, probes, history).run();
  reuse.points = std::move(points);
  reuse.probes = std::move(probes);
  return reuse;
}

}  // namespace gatelight::renderer

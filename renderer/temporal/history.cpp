#include "renderer/temporal/history.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/parallel/loops.h"
#include "renderer/image/box_filter.h"

namespace gatelight::renderer {
namespace {

/// The earlier point of a pixel lies near the present one: in normal direction at most this many pixels away,
/// along the surface this many.
constexpr float kMaxAcross = 1.0f, kMaxAlong = 3.0f;
/// Pixels so near an edge, in each direction, mix the light of surfaces: filters of pixels and the denoiser
/// reach as far. What they show is not carried. A dark arch before a sunlit wall would grow brighter as it
/// comes nearer.
constexpr int kAroundEdge = 2;
/// The cosine of normals below which they belong to different surfaces.
constexpr float kMinNormalCosine = 0.9f;
/// Pixels around, in each direction, whose probes are compared. Their light is the same up to the first
/// relative change, and another from the second on.
constexpr int kAroundProbe = 2;
constexpr float kUnchanged = 0.03f, kChanged = 0.2f;
/// Old light that is wrong by a change c counts for at most so many of the frame's samples, over c: then the
/// error of the mean stays below this, however many changes add up. From the second on nothing is carried.
constexpr float kMaxError = 0.01f, kOther = 0.1f;

bool same_surface(const VisiblePoint& there, const VisiblePoint& now, const EarlierPoint& earlier) {
  if (!there.hit || there.hit.instance != now.hit.instance || there.layers != now.layers) return false;
  if (there.normal.dot(earlier.normal) < kMinNormalCosine) return false;
  const Vec3 apart = there.position - earlier.position;
  const float width = std::max(there.width, now.width);
  const float across = std::abs(apart.dot(earlier.normal));
  // A pixel is longer on a surface that is seen from the side.
  return across <= kMaxAcross * width &&
         apart.squaredNorm() <= 400.0f * kMaxAlong * kMaxAlong * width * width;
}

/// How far the light still holds that depends on the view.
float same_gloss(const VisiblePoint& now, const EarlierPoint& earlier) {
  const float turned = (now.reflected - earlier.reflected).norm() / now.lobe;
  return 1.0f - now.glossy * (1.0f - std::exp(-turned * turned));
}

class Reprojector {
 public:
  Reprojector(const Film& film, const VisiblePoints& points, const std::vector<Color>& probes,
              const History* history)
      : rect_(film.rect()),
        points_(points),
        probes_(probes),
        history_(history),
        frame_{rect_,
               film.plane(Plane::mean, rect_.y0, rect_.y1),
               film.plane(Plane::albedo, rect_.y0, rect_.y1),
               {},
               {}},
        film_(film),
        carried_(film.pixels()) {}

  CarriedLight run() {
    frame_.count.resize(carried_.size());
    frame_.variance.resize(carried_.size());
    for_each_pixel([&](std::size_t i) {
      frame_.count[i] = static_cast<float>(film_.sums().radiance[i].count);
      frame_.variance[i] = variance_of_light(i);
    });
    edges_.resize(carried_.size());
    for_each_pixel([&](std::size_t i) { edges_[i] = is_edge(i) ? 1.0f : 0.0f; });
    box_filter(edges_, rect_.width(), rect_.height(), kAroundEdge);
    if (history_) {
      carry();
      if (!points_.changes.empty()) compare_surfaces();
      if (!probes_.empty() && !history_->probes.empty()) compare_probes();
      compare_samples(frame_, carried_);
      match_brightness(frame_, carried_);
    }
    return with_carried(frame_, carried_, edges_);
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

  ReprojectedSample carry(std::size_t i) const {
    const VisiblePoint& now = points_.now[i];
    const EarlierPoint& earlier = *points_.earlier[i];
    const float x = earlier.pixel.x() - 0.5f, y = earlier.pixel.y() - 0.5f;
    const float left = std::floor(x), top = std::floor(y), u = x - left, v = y - top;
    const PixelRect& r = history_->rect;
    ReprojectedSample sum;
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
    sum.samples = std::min(sum.samples, kMaxEarlier * frame_.count[i]) * weights * same_gloss(now, earlier);
    sum.probe /= weights;
    return sum;
  }

  /// Whether the pixel shows parts of several surfaces.
  bool is_edge(std::size_t i) const {
    const auto width = static_cast<std::size_t>(rect_.width());
    const std::size_t x = i % width;
    const auto differs = [&](std::size_t j) {
      const VisiblePoint &a = points_.now[i], &b = points_.now[j];
      if (a.hit.instance != b.hit.instance || a.normal.dot(b.normal) < kMinNormalCosine) return true;
      return std::abs((a.position - b.position).dot(a.normal)) > 2.0f * a.width;
    };
    return (x > 0 && differs(i - 1)) || (x + 1 < width && differs(i + 1)) ||
           (i >= width && differs(i - width)) || (i + width < points_.now.size() && differs(i + width));
  }

  /// Takes so little over that the mean stays right, where the surface is another one.
  void compare_surfaces() {
    std::vector<float> change = points_.changes;
    box_filter(change, rect_.width(), rect_.height(), kAroundLow);
    for_each_pixel([&](std::size_t i) {
      if (!(change[i] > 0.0f)) return;
      const float most = change[i] < kOther ? frame_.count[i] * kMaxError / change[i] : 0.0f;
      carried_[i].samples = std::min(carried_[i].samples, most);
    });
  }

  /// Takes less over where the light of the probes has changed, and as bright as they are now.
  void compare_probes() {
    const std::size_t pixels = carried_.size();
    std::vector<float> difference(pixels), light(pixels);
    std::array<std::vector<float>, 3> now, before;
    for (std::size_t c = 0; c < 3; ++c) {
      now[c].resize(pixels);
      before[c].resize(pixels);
    }
    for_each_pixel([&](std::size_t i) {
      if (!(carried_[i].samples > 0.0f)) return;
      const Color &probe = probes_[i], &carried = carried_[i].probe;
      difference[i] = luminance((probe - carried).abs());
      light[i] = luminance(probe.max(carried));
      for (std::size_t c = 0; c < 3; ++c) {
        now[c][i] = probe[static_cast<Eigen::Index>(c)];
        before[c][i] = carried[static_cast<Eigen::Index>(c)];
      }
    });
    for (std::vector<float>* plane :
         {&difference, &light, &now[0], &now[1], &now[2], &before[0], &before[1], &before[2]})
      box_filter(*plane, rect_.width(), rect_.height(), kAroundProbe);
    for_each_pixel([&](std::size_t i) {
      const float change = light[i] > 0.0f ? difference[i] / light[i] : 0.0f;
      carried_[i].samples *= std::clamp((kChanged - change) / (kChanged - kUnchanged), 0.0f, 1.0f);
      for (std::size_t c = 0; c < 3; ++c) {
        if (!(before[c][i] > 0.0f)) continue;
        carried_[i].color[static_cast<Eigen::Index>(c)] *=
            std::clamp(now[c][i] / before[c][i], 1.0f / kMaxRatio, kMaxRatio);
      }
    });
  }

  /// The variance of the mean of a pixel's luminance, without the surface's colour.
  float variance_of_light(std::size_t i) const {
    const RadianceSum& p = film_.sums().radiance[i];
    if (p.count < 2) {
      const float light = light_of(&frame_.color[3 * i], &frame_.albedo[3 * i]);
      return light * light;
    }
    const double n = p.count;
    Color variance;
    for (std::size_t c = 0; c < 3; ++c) {
      const double mean = p.sum[c] / n;
      const float f = light_divisor(frame_.albedo[3 * i + c]);
      variance[static_cast<Eigen::Index>(c)] =
          static_cast<float>(std::max(p.square[c] / n - mean * mean, 0.0) / (n - 1.0)) / (f * f);
    }
    return variance.maxCoeff();
  }

  PixelRect rect_;
  const VisiblePoints& points_;
  const std::vector<Color>& probes_;
  const History* history_;  ///< null: there is none
  FrameSamples frame_;
  std::vector<float> edges_;
  const Film& film_;
  std::vector<ReprojectedSample> carried_;
};

}  // namespace

Reuse reuse_samples(const Film& film, VisiblePoints points, std::vector<Color> probes,
                    const History* history) {
  Reuse reuse{Reprojector(film, points, probes, history).run()};
  if (!history) reuse.color.clear();
  reuse.points = std::move(points);
  reuse.probes = std::move(probes);
  return reuse;
}

}  // namespace gatelight::renderer

#include "renderer/reconstruction/outliers.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "renderer/image/box_filter.h"

namespace gatelight::renderer {
namespace {

/// An outlier is so many deviations above the mean of its neighbours.
constexpr float kDeviations = 3.0f;
/// And so many times as bright as any pixel beside it in the other half.
constexpr float kTimesOther = 2.0f;
/// Radius of the neighbourhood that an outlier is compared with.
constexpr int kNear = 5;
/// Radius of the neighbourhood that gets its light.
constexpr int kFar = 12;
/// One outlier gives its neighbours at most so much of their own light: more would be seen as a square.
constexpr float kMostOfOne = 0.02f;
/// A pixel gets at most so many times its own light from all of them.
constexpr float kMostGain = 1.0f;
static_assert(kOutlierReach == 2 * kFar + kNear);

/// The pixels of a square around x, y that are in the picture.
struct Square {
  int left, right, top, bottom;

  Square(int x, int y, int radius, int width, int height)
      : left(std::max(x - radius, 0)),
        right(std::min(x + radius + 1, width)),
        top(std::max(y - radius, 0)),
        bottom(std::min(y + radius + 1, height)) {}
  float count() const { return static_cast<float>((right - left) * (bottom - top)); }
};

class Outliers {
 public:
  Outliers(HalfPlanes& a, HalfPlanes& b, int width, int height)
      : width_(width), height_(height), halves_{&a, &b} {
    mean_square_.resize(at(0, height));
    for (Plane& plane : brightness_) plane.resize(mean_square_.size());
    for (Plane& plane : share_) plane.assign(mean_square_.size(), 1.0f);
    each_pixel([&](std::size_t p, int, int) {
      for (int h = 0; h < 2; ++h) {
        for (const Plane& plane : halves_[h]->color) brightness_[h][p] += plane[p];
        mean_square_[p] += 0.5f * brightness_[h][p] * brightness_[h][p];
      }
    });
    box_filter(mean_square_, width, height, kNear);
    each_pixel([&](std::size_t p, int x, int y) {
      for (int h = 0; h < 2; ++h) {
        const float limit = limit_of(h, p, x, y), own = brightness_[h][p];
        if (own > limit) share_[h][p] = limit / own;
      }
    });
  }

  void spread(const Plane (&divisor)[3], Plane& lost) {
    lost.assign(mean_square_.size(), 0.0f);
    for (int c = 0; c < 3; ++c) {
      Plane gain(mean_square_.size()), kept(mean_square_.size());
      each_pixel([&](std::size_t p, int, int) {
        for (int h = 0; h < 2; ++h) {
          const float light = halves_[h]->color[c][p] * divisor[c][p];
          gain[p] += light * (1.0f - share_[h][p]);
          kept[p] += light * share_[h][p];
        }
        lost[p] += gain[p];
      });
      box_filter(kept, width_, height_, kFar);
      // What a pixel gives over the light of all that receive it. They get as much as was given, as "to be in
      // each other's neighbourhood" is symmetric.
      each_pixel([&](std::size_t p, int x, int y) {
        const float n = Square(x, y, kFar, width_, height_).count();
        gain[p] = kept[p] > 0.0f ? std::min(gain[p] / (kept[p] * n), kMostOfOne) : 0.0f;
      });
      box_filter(gain, width_, height_, kFar);
      each_pixel([&](std::size_t p, int x, int y) {
        const float n = Square(x, y, kFar, width_, height_).count();
        const float more = 1.0f + std::min(gain[p] * n, kMostGain);
        for (int h = 0; h < 2; ++h) {
          const float times = share_[h][p] * more;
          lost[p] -= halves_[h]->color[c][p] * divisor[c][p] * share_[h][p] * (more - 1.0f);
          halves_[h]->color[c][p] *= times;
          halves_[h]->variance[c][p] *= times * times;
        }
      });
    }
  }

 private:
  template <class Function>
  void each_pixel(Function function) const {
    tbb::parallel_for(0, height_, [&](int y) {
      for (int x = 0; x < width_; ++x) function(at(x, y), x, y);
    });
  }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  /// How bright half h of a pixel may be.
  float limit_of(int h, std::size_t p, int x, int y) const {
    const Square near(x, y, kNear, width_, height_);
    const float own = brightness_[h][p], others = 2.0f * near.count() - 1.0f;
    // With this square in the mean of all squares it could not be an outlier.
    const float all = (others + 1.0f) * mean_square_[p];
    if (!(1.01f * own * own * (1.0f + others / (kDeviations * kDeviations)) > all)) return own;
    float sum = 0.0f, squares = 0.0f, beside = 0.0f;
    for (int v = near.top; v < near.bottom; ++v) {
      for (int u = near.left; u < near.right; ++u) {
        const std::size_t q = at(u, v);
        const float other = brightness_[1 - h][q], same = q == p ? 0.0f : brightness_[h][q];
        sum += other + same;
        squares += other * other + same * same;
        if (std::abs(u - x) <= 1 && std::abs(v - y) <= 1) beside = std::max(beside, other);
      }
    }
    return std::max((sum + kDeviations * std::sqrt(squares * others)) / others, kTimesOther * beside);
  }

  int width_;
  int height_;
  HalfPlanes* halves_[2];
  Plane brightness_[2];  ///< sum of the channels
  Plane mean_square_;    ///< of the brightness of both halves around a pixel
  Plane share_[2];       ///< of its light that a pixel keeps
};

}  // namespace

Plane spread_outliers(HalfPlanes& a, HalfPlanes& b, const Plane (&divisor)[3], int width, int height) {
  Plane lost;
  Outliers(a, b, width, height).spread(divisor, lost);
  return lost;
}

}  // namespace gatelight::renderer

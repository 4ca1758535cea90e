#include "renderer/reconstruction/region.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "renderer/image/box_filter.h"
#include "renderer/reconstruction/dealt_layout.h"

namespace gatelight::renderer {
namespace {

/// Colours are divided by at least this, or dark surfaces would be all noise.
constexpr float kLeastDivisor = 0.02f;
/// Non-local means: differences count in these standard deviations.
constexpr float kBandwidth = 0.5f;
/// Few samples do not tell how they vary, nor the error of a fit. So many halve the doubt that their mean is
/// the better one.
constexpr float kDoubt = 2.0f;
/// Pixels of one surface: normals and divisors differ by less.
constexpr float kEdge = 0.45f;
/// Relative to the cache's answers, differences that say nothing.
constexpr float kCacheNoise = 0.02f;
/// A pixel's own samples count as a window of this weight where windows hardly reach it.
constexpr float kOwnWeight = 0.6f;
/// Radius of the squares over which estimates of errors are smoothed.
constexpr int kErrorSmoothing = 5;
/// Windows add up in bands of so many rows: first the even bands, then the odd ones.
constexpr int kBandWindows = 8;
static_assert(kHalo % window::kStride == 0);
/// Windows, their patches and variances, and the smoothing of errors.
constexpr int kFitReach =
    2 * window::kRadius + window::kPatch + 1 + 2 * kErrorSmoothing + kErrorSmoothing / 2;
static_assert(kHalo >= kFitReach + kOutlierReach);
/// So far from a row the centres of windows may lie that decide it.
constexpr int kWindowReach = window::kRadius + 2 * kErrorSmoothing + kErrorSmoothing / 2 + window::kStride;
static_assert(kBandWindows * window::kStride >= 2 * window::kRadius + 1);

float saturated(double x) {
  return static_cast<float>(std::clamp(x, -1e12, 1e12));
}

template <class Function>
void for_each_row(int height, Function function) {
  tbb::parallel_for(0, height, function);
}

}  // namespace

Region::Region(const SampledPicture& samples, int top, int first, int end, float scale)
    : width_(samples.width), height_(end - first), first_(first), scale_(scale) {
  read(samples, top);
  complete_variance();
  fill_gaps();
  lost_ = spread_outliers(halves_[0], halves_[1], divisor_, width_, height_);
}

void Region::read(const SampledPicture& s, int top) {
  const auto each = [&](auto&& function) {
    for (Half& half : halves_) {
      for (int c = 0; c < 3; ++c) function(half.color[c]), function(half.variance[c]);
    }
    for (int c = 0; c < 3; ++c) function(divisor_[c]), function(normal_[c]);
    function(counts_), function(coverage_), function(depth_);
  };
  each([&](Plane& plane) { plane.resize(pixels()); });
  const bool cached = !s.halves[0].cache.empty();
  if (cached) {
    for (auto& half : cache_) {
      for (Plane& plane : half) plane.resize(pixels());
    }
    cache_noise_.resize(pixels());
  }
  const std::size_t offset = static_cast<std::size_t>(first_ - top) * static_cast<std::size_t>(width_);
  for_each_row(height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      const std::size_t p = at(x, y);
      const std::size_t from = offset + p;
      counts_[p] = s.counts[from];
      coverage_[p] = s.coverage[from];
      depth_[p] = std::max(s.depth[from], 0.0f);
      for (std::size_t c = 0; c < 3; ++c) {
        normal_[c][p] = std::clamp(s.normal[3 * from + c], -1.0f, 1.0f);
        // What was not hit reflects nothing and counts as white.
        const float reflects = s.albedo[3 * from + c] + 1.0f - s.coverage[from];
        divisor_[c][p] = std::clamp(reflects, kLeastDivisor, 1.0f);
        const double over = 1.0 / (static_cast<double>(scale_) * static_cast<double>(divisor_[c][p]));
        if (cached) {
          const float a = saturated(static_cast<double>(s.halves[0].cache[3 * from + c]) * over);
          const float b = saturated(static_cast<double>(s.halves[1].cache[3 * from + c]) * over);
          // Noise of the cache behind the guides' surface is that of the half's own samples.
          const float behind = s.behind.empty() ? 0.0f : std::clamp(s.behind[from], 0.0f, 1.0f);
          const float other = 0.5f + 0.5f * behind;
          cache_[0][c][p] = a + other * (b - a);
          cache_[1][c][p] = b + other * (a - b);
          cache_noise_[p] += (a - b) * (a - b) / 12.0f;
        }
        for (int h = 0; h < 2; ++h) {
          // A pixel of one sample has one half.
          const SampledPicture::Half& half = s.halves[s.counts[from] < 2.0f ? 0 : h];
          halves_[h].color[c][p] = saturated(static_cast<double>(half.color[3 * from + c]) * over);
          halves_[h].variance[c][p] =
              saturated(static_cast<double>(half.variance[3 * from + c]) * over * over);
        }
      }
    }
  });
}

/// Where a half has fewer than two samples, its variance is that between neighbours of the same surface. The
/// other half may not tell it: neither how its samples are weighed nor how many it gets may depend on them.
void Region::complete_variance() {
  const auto unlikeness = [&](std::size_t p, std::size_t q) {
    float sum = 0.0f;
    for (const auto* planes : {&normal_, &divisor_}) {
      for (const Plane& plane : *planes) sum += (plane[p] - plane[q]) * (plane[p] - plane[q]);
    }
    return sum;
  };
  for_each_row(height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      const std::size_t p = at(x, y);
      if (!(counts_[p] < 4.0f)) continue;
      float total = 0.0f, sums[2][3] = {};
      for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
        const int u = x + dx, v = y + dy;
        if (u < 0 || u >= width_ || v < 0 || v >= height_) continue;
        const std::size_t q = at(u, v);
        const float alike = std::exp(-unlikeness(p, q) / (kEdge * kEdge)) + 1e-6f;
        total += alike;
        for (int h = 0; h < 2; ++h) {
          for (int c = 0; c < 3; ++c) {
            const float e = halves_[h].color[c][p] - halves_[h].color[c][q];
            sums[h][c] += alike * 0.5f * e * e;
          }
        }
      }
      for (int h = 0; h < 2; ++h) {
        for (int c = 0; c < 3; ++c) halves_[h].variance[c][p] = sums[h][c] / std::max(total, 1e-6f);
      }
    }
  });
}

/// A pixel without samples looks like those around it, and could be anything.
void Region::fill_gaps() {
  constexpr float kAnything = 1e6f;
  for_each_row(height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      const std::size_t p = at(x, y);
      if (counts_[p] > 0.0f) continue;
      for (Half& half : halves_) {
        for (int c = 0; c < 3; ++c) {
          float sum = 0.0f, count = 0.0f;
          for (int v = std::max(y - window::kPatch, 0); v <= std::min(y + window::kPatch, height_ - 1); ++v) {
            for (int u = std::max(x - window::kPatch, 0); u <= std::min(x + window::kPatch, width_ - 1);
                 ++u) {
              if (!(counts_[at(u, v)] > 0.0f)) continue;
              sum += half.color[c][at(u, v)];
              count += 1.0f;
            }
          }
          half.color[c][p] = sum / std::max(count, 1.0f);
          half.variance[c][p] = kAnything;
        }
      }
    }
  });
}

/// The sum of the channels, a little smoothed: variances of few samples are noise themselves.
Plane Region::smooth_variance(const Half& half) const {
  Plane variance(pixels());
  for_each_row(height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      const std::size_t p = at(x, y);
      for (int c = 0; c < 3; ++c) variance[p] += half.variance[c][p];
    }
  });
  box_filter(variance, width_, height_, 1);
  return variance;
}

/// Few samples find the shares of several surfaces in a pixel only roughly. How roughly, their normals tell:
/// the mean of different ones is short.
Plane Region::edge_noise() const {
  constexpr float kNoise = 2.0f;  // of normals and of the divisors that change with them
  Plane noise(pixels());
  for (std::size_t p = 0; p < pixels(); ++p) {
    float square = 0.0f;
    for (int c = 0; c < 3; ++c) square += normal_[c][p] * normal_[c][p];
    const float spread = std::max(coverage_[p] - square, 0.0f);
    noise[p] = kNoise * spread / (std::max(counts_[p] - 1.0f, 1.0f) * kEdge * kEdge);
  }
  return noise;
}

/// Of the cache's picture: its noise, from the difference of the halves, and a little that changes from texel
/// to texel of its features.
Plane Region::cache_variance() const {
  Plane usual(pixels()), variance(cache_noise_);
  for (std::size_t p = 0; p < pixels(); ++p) {
    for (const auto& half : cache_) usual[p] += (half[0][p] + half[1][p] + half[2][p]) / 6.0f;
  }
  box_filter(usual, width_, height_, 3);
  box_filter(variance, width_, height_, 3);
  for (std::size_t p = 0; p < pixels(); ++p) {
    const float e = kCacheNoise * usual[p];
    variance[p] += e * e + 1e-8f;
  }
  return variance;
}

void Region::fit(const ReconstructionKernels& kernels, int from_row, int to_row) {
  const DealtLayout layout(width_, height_);
  // Windows of the whole picture are counted, so that bands are the same in every region.
  const int above = first_ / window::kStride;
  const int from = std::max((from_row - kWindowReach) / window::kStride, above);
  const int to = std::min((to_row + kWindowReach) / window::kStride + 1, above + layout.rows());
  std::vector<Plane> planes;
  const auto keep = [&](Plane plane) {
    planes.push_back(std::move(plane));
    return planes.back().data();
  };
  const auto mapped = [&](const Plane& plane, auto&& map) {
    Plane result(plane.size());
    std::transform(plane.begin(), plane.end(), result.begin(), map);
    return layout.deal_clamped(result);
  };
  BandView band;
  band.columns = layout.columns();
  band.row = layout.row();
  band.phase = layout.phase();
  for (int h = 0; h < 2; ++h) {
    for (int c = 0; c < 3; ++c) band.halves[h].color[c] = keep(layout.deal_clamped(halves_[h].color[c]));
    band.halves[h].variance = keep(layout.deal_clamped(smooth_variance(halves_[h])));
  }
  Plane valid(pixels());
  std::transform(counts_.begin(), counts_.end(), valid.begin(),
                 [](float n) { return n > 0.0f ? 1.0f : 0.0f; });
  band.valid = keep(layout.deal(valid));
  // What a guide's value does not tell: less than this is noise or rounding.
  const auto set_guide = [&](int i, const Plane& plane, auto&& variance) {
    band.guides[i] = keep(layout.deal_clamped(plane));
    band.guide_variance[i] = keep(mapped(plane, variance));
  };
  for (int c = 0; c < 3; ++c) set_guide(c, normal_[c], [](float) { return 1e-3f; });
  set_guide(3, depth_, [](float z) { return 1e-4f * z * z + 1e-12f; });
  if (!cache_noise_.empty()) {
    const float* const variance = keep(layout.deal_clamped(cache_variance()));
    for (int c = 0; c < 3; ++c) band.guide_variance[4 + c] = variance;
    band.guide_count = kMostGuides;
  }
  for (int c = 0; c < 3; ++c) {
    const auto over = [](float x) { return x / kEdge; };
    band.edges[c] = keep(mapped(normal_[c], over));
    band.edges[3 + c] = keep(mapped(divisor_[c], over));
  }
  band.edge_noise = keep(layout.deal_clamped(edge_noise()));

  for (int h = 0; h < 2; ++h) {
    Plane cache[3];
    for (int c = 0; c < 3 && !cache_noise_.empty(); ++c) {
      cache[c] = layout.deal_clamped(cache_[h][c]);
      band.guides[4 + c] = cache[c].data();
    }
    std::vector<Plane> sums(5, Plane(layout.size(), 0.0f));
    const FitView out{{sums[0].data(), sums[1].data(), sums[2].data()}, sums[3].data(), sums[4].data()};
    const int first_pair = from / (2 * kBandWindows), end_pair = (to - 1) / (2 * kBandWindows) + 1;
    for (const int odd : {0, 1}) {
      tbb::parallel_for(
          tbb::blocked_range<int>(first_pair, end_pair, 1),
          [&](const tbb::blocked_range<int>& range) {
            for (int pair = range.begin(); pair < range.end(); ++pair) {
              const int begin = (2 * pair + odd) * kBandWindows;
              for (int r = std::max(begin, from); r < std::min(begin + kBandWindows, to); ++r) {
                kernels.fit_row(band, out, window::kMargin + window::kFirst + (r - above) * window::kStride,
                                h, kBandwidth);
              }
            }
          },
          tbb::simple_partitioner());
    }
    Half& half = halves_[h];
    for (Plane& plane : half.fit) plane.resize(pixels());
    half.influence.resize(pixels());
    for_each_row(height_, [&](int y) {
      for (int x = 0; x < width_; ++x) {
        const std::size_t p = at(x, y);
        const std::size_t dealt = layout.at(x, y);
        const float own = valid[p] * kOwnWeight / (1.0f + sums[3][dealt] * sums[3][dealt]);
        const float over = 1.0f / std::max(sums[3][dealt] + own, 1e-20f);
        for (int c = 0; c < 3; ++c)
          half.fit[c][p] = (sums[static_cast<std::size_t>(c)][dealt] + own * half.color[c][p]) * over;
        half.influence[p] = std::min((sums[4][dealt] + own) * over, 1.0f);
      }
    });
  }
}

/// With the fits a, b of the halves and errors e_a, e_b: |(e_a + e_b) / 2|^2 = (|e_a|^2 + |e_b|^2) / 2 -
/// |a - b|^2 / 4. The squared error of a fit is estimated by |fit - samples|^2 - variance + 2 variance
/// influence (Stein 1981), which is unbiased, because the weights of a half are made of the other one. The
/// best share of the samples' mean in the result follows from the same terms.
void Region::join() {
  constexpr float kMostDeviations = 3.0f;
  constexpr float kLeastSquare = 1e-3f;  // of brightness, below which errors count as absolute
  Plane error(pixels()), distance(pixels()), shared(pixels()), square(pixels());
  const auto each_pixel = [&](auto&& function) {
    for_each_row(height_, [&](int y) {
      for (int x = 0; x < width_; ++x) {
        function(at(x, y));
      }
    });
  };
  for (Plane& plane : color_) plane.resize(pixels());
  const auto raw = [&](std::size_t p, int c) {
    const float n = std::max(counts_[p], 2.0f), b = std::floor(0.5f * n);
    return ((n - b) * halves_[0].color[c][p] + b * halves_[1].color[c][p]) / n;
  };
  each_pixel([&](std::size_t p) {
    for (int c = 0; c < 3; ++c) {
      const float a = halves_[0].fit[c][p], b = halves_[1].fit[c][p];
      const float mean = color_[c][p] = 0.5f * (a + b);
      square[p] += mean * mean;
      error[p] -= 0.25f * (a - b) * (a - b);
      const float d = mean - raw(p, c);
      distance[p] += d * d;
      for (const Half& half : halves_) {
        const float e = half.fit[c][p] - half.color[c][p], variance = half.variance[c][p];
        error[p] += 0.5f * (e * e - variance) + variance * half.influence[p];
        shared[p] += 0.25f * variance * half.influence[p];
      }
    }
  });
  const auto smooth = [&](Plane& plane) { box_filter(plane, width_, height_, kErrorSmoothing); };
  smooth(square);
  Plane deviation(pixels());
  each_pixel([&](std::size_t p) {
    const float over = counts_[p] > 0.0f ? 1.0f / (square[p] + kLeastSquare) : 0.0f;
    for (Plane* plane : {&error, &distance, &shared}) (*plane)[p] *= over;
    deviation[p] = std::sqrt(distance[p]);
  });
  for (Plane* plane : {&error, &distance, &shared, &deviation}) smooth(*plane);
  for (Plane* plane : {&error, &distance, &shared}) box_filter(*plane, width_, height_, kErrorSmoothing / 2);
  error_.resize(pixels());
  each_pixel([&](std::size_t p) {
    float share = 0.0f, best = 0.0f;
    // One sample has no second half to tell its error.
    if (counts_[p] >= 2.0f) {
      const float doubt = kDoubt / (kDoubt + counts_[p]);
      best = std::clamp((error[p] - shared[p]) / std::max(distance[p], 1e-20f), 0.0f, 1.0f);
      share = std::max((best - doubt) / (1.0f - doubt), 0.0f);
    }
    // What is not believed of the fit's error does not count in its estimate either.
    const float joined = error[p] - 2.0f * best * (error[p] - shared[p]) + best * best * distance[p];
    error_[p] = std::max(joined, 0.0f) * (square[p] + kLeastSquare) / 3.0f;
    if (share > 0.0f) {
      // A bright sample differs much from the fit, but not much for its own variance: it stays out.
      const float usual = kMostDeviations * deviation[p] * std::sqrt(square[p] + kLeastSquare);
      for (int c = 0; c < 3; ++c) {
        const float noise = 0.5f * std::sqrt(halves_[0].variance[c][p] + halves_[1].variance[c][p]);
        const float d = raw(p, c) - color_[c][p];
        const float limit = usual + std::max(std::abs(d) - kMostDeviations * noise, 0.0f);
        const float added = share * std::clamp(d, -limit, limit);
        color_[c][p] += added;
        const float part = d != 0.0f ? added / d : 0.0f;
        for (Half& half : halves_) half.fit[c][p] += part * (half.color[c][p] - half.fit[c][p]);
      }
    }
  });
}

std::array<double, 2> Region::light_of_row(int y) const {
  const std::size_t row = static_cast<std::size_t>(y - first_) * static_cast<std::size_t>(width_);
  double kept = 0.0, lost = 0.0;
  for (std::size_t p = row; p < row + static_cast<std::size_t>(width_); ++p) {
    lost += static_cast<double>(lost_[p]);
    for (const Half& half : halves_) {
      for (int c = 0; c < 3; ++c) kept += static_cast<double>(half.color[c][p] * divisor_[c][p]);
    }
  }
  return {kept, lost};
}

void Region::write_row(int y, Row to) const {
  const std::size_t row = static_cast<std::size_t>(y - first_) * static_cast<std::size_t>(width_);
  for (int x = 0; x < width_; ++x) {
    const std::size_t p = row + static_cast<std::size_t>(x);
    for (int c = 0; c < 3; ++c) {
      const double unit = static_cast<double>(scale_) * static_cast<double>(divisor_[c][p]);
      const auto color = [&](const Plane& plane) {
        return static_cast<float>(std::max(static_cast<double>(plane[p]), 0.0) * unit);
      };
      *to.color++ = color(color_[c]);
      for (int h = 0; h < 2; ++h) *to.halves[h]++ = color(halves_[h].fit[c]);
      *to.error++ = static_cast<float>(std::sqrt(static_cast<double>(error_[p])) * unit);
    }
    for (int h = 0; h < 2; ++h) {
      const Half& half = halves_[h];
      double square = 0.0;
      for (int c = 0; c < 3; ++c) {
        const double unit = static_cast<double>(scale_) * static_cast<double>(divisor_[c][p]);
        square += static_cast<double>(half.variance[c][p]) * unit * unit / 3.0;
      }
      *to.noise[h]++ =
          static_cast<float>(std::sqrt(square * static_cast<double>(halves_[1 - h].influence[p])));
    }
  }
}

}  // namespace gatelight::renderer

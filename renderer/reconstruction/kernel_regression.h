#pragma once
// Weighted first-order regression in windows (Bitterli et al. 2016, "Nonlinearly weighted first-order
// regression for denoising Monte Carlo renderings"), one window for each lane. Part of kernel_table.cpp.

#include "neural/simd/vectors.h"
#include "renderer/reconstruction/kernels.h"

namespace {

using namespace gatelight::renderer;

/// Where the columns around a window's centre lie in a row of a plane.
struct Columns {
  static constexpr int kReach = window::kRadius + window::kPatch;
  size_t at[2 * kReach + 1];

  explicit Columns(const BandView& band) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      const int x = window::kMargin + window::kFirst + dx;
      at[dx + kReach] =
          static_cast<size_t>(x % window::kStride) * band.phase + static_cast<size_t>(x / window::kStride);
    }
  }
};

/// The windows of one row that fill the lanes.
struct Windows {
  const BandView& band;
  const Columns& columns;
  int y;      ///< of their centres
  int first;  ///< number of the first one in its row

  /// Of the first lane's pixels in the row dy from the centre.
  GATELIGHT_INLINE size_t row(int dy) const {
    return static_cast<size_t>(y + dy) * band.row + static_cast<size_t>(first);
  }
  /// Of the pixel dx, dy from the first centre.
  GATELIGHT_INLINE size_t at(int dx, int dy) const { return row(dy) + columns.at[dx + Columns::kReach]; }
};

/// exp(-x) for x in [0, 80], within 2e-7 of the value.
GATELIGHT_INLINE Float exp_of_minus(Float x) {
  const Float t = x * 1.44269504088896f;
  const Int whole = to_int(t + 0.5f);
  const Float f = (to_float(whole) - t) * 0.693147180559945f;  // in [-ln 2 / 2, ln 2 / 2]
  const Float p =
      1.0f + f * (1.0f + f * (0.5f + f * (1.0f / 6 + f * (1.0f / 24 + f * (1.0f / 120 + f * (1.0f / 720))))));
  return p * float_of((Int(127u) - whole) << 23);
}

/// The patches around the centres.
struct Patches {
  static constexpr int kSide = 2 * window::kPatch + 1;
  Float color[kSide][kSide][3];
  Float variance[kSide][kSide];

  GATELIGHT_INLINE Patches(const Windows& w, const HalfView& half) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const size_t p = w.at(x - window::kPatch, y - window::kPatch);
        for (int c = 0; c < 3; ++c) color[y][x][c] = load(half.color[c] + p);
        variance[y][x] = load(half.variance + p);
      }
    }
  }
};

/// The distance of the patches from those around the pixels dx, dy from the centres: squared differences
/// beyond what the variances explain, over the variances (Rousselle et al. 2012, equation 3). Each pixel's
/// ratio is bounded, so that one bright sample does not decide for its patch.
GATELIGHT_INLINE Float patch_distance(const Windows& w, const HalfView& half, const Patches& patches,
                                      float k2, int dx, int dy) {
  constexpr int kSide = Patches::kSide;
  const size_t* const columns = &w.columns.at[dx + Columns::kReach - window::kPatch];
  Float sum = 0.0f;
  for (int y = 0; y < kSide; ++y) {
    const size_t row = w.row(dy + y - window::kPatch);
    for (int x = 0; x < kSide; ++x) {
      const size_t q = row + columns[x];
      Float e2 = 0.0f;
      for (int c = 0; c < 3; ++c) {
        const Float e = patches.color[y][x][c] - load(half.color[c] + q);
        e2 += e * e;
      }
      const Float vp = patches.variance[y][x], vq = load(half.variance + q);
      sum += (e2 - (vp + min(vp, vq))) / (1e-6f + k2 * (vp + vq));
    }
  }
  return sum * (1.0f / (kSide * kSide));
}

/// The weights of all pixels of the windows: non-local means of the half (Rousselle et al. 2012) times a
/// Gaussian of the edges.
struct Weights {
  alignas(64) float values[window::kSide * window::kSide][kLanes];
};

/// So many neighbouring windows add up together, for any number of lanes: a pixel gets their fits in the same
/// order.
constexpr int kTogether = 16;
constexpr int kVectors = kTogether / kLanes;

GATELIGHT_INLINE void find_weights(const Windows& w, const HalfView& half, float bandwidth,
                                   Weights& weights) {
  constexpr int kRadius = window::kRadius;
  constexpr float kFarthest = 4.6f;  // a weight of 0.01
  const BandView& band = w.band;
  const size_t p = w.at(0, 0);
  const float k2 = bandwidth * bandwidth;
  const Patches patches(w, half);
  int n = 0;
  for (int dy = -kRadius; dy <= kRadius; ++dy) {
    for (int dx = -kRadius; dx <= kRadius; ++dx, ++n) {
      const size_t q = w.at(dx, dy);
      Float edges = -load(band.edge_noise + p) - load(band.edge_noise + q);
      for (int e = 0; e < kEdges; ++e) {
        const Float d = load(band.edges[e] + p) - load(band.edges[e] + q);
        edges += d * d;
      }
      edges = max(edges, 0.0f);
      Float weight = 0.0f;
      if (any(edges < kFarthest)) {
        const Float d = max(patch_distance(w, half, patches, k2, dx, dy), 0.0f) + edges;
        weight = select_or_zero(d < kFarthest, exp_of_minus(min(d, kFarthest)));
      }
      store(weights.values[n], weight);
    }
  }
}

/// Upper triangles of so many rows as there are guides.
template <int kGuides>
struct Triangle {
  static constexpr int kSize = kGuides * (kGuides + 1) / 2;
  /// The place of (i, j), i <= j.
  static constexpr int place(int i, int j) { return i * kGuides - i * (i - 1) / 2 + j - i; }
};

/// The fit in each lane's window: colour c at a pixel is mean[c] + sum of slope[i][c] *
/// (guide i - centre[i]).
template <int kGuides>
struct Fit {
  Float total;  ///< sum of the weights
  Float mean[3];
  Float center[kGuides];
  Float slope[kGuides][3];
  /// Of the guides' moments: L D L^T = M. Above the diagonal rows of L^T; on it 1 / D.
  Float factor[Triangle<kGuides>::kSize];
};

template <int kGuides>
GATELIGHT_INLINE Fit<kGuides> find_fit(const Windows& w, const HalfView& half, const Weights& weights) {
  constexpr int kMoments = Triangle<kGuides>::kSize;
  constexpr auto place = Triangle<kGuides>::place;
  constexpr int kRadius = window::kRadius;
  const BandView& band = w.band;
  const size_t p = w.at(0, 0);
  Float origin[kGuides], sum[kGuides], moment[kMoments];
  Float cross[kGuides][3], color[3];
  Float total = 0.0f;
  for (int c = 0; c < 3; ++c) color[c] = 0.0f;
  for (int i = 0; i < kGuides; ++i) {
    origin[i] = load(band.guides[i] + p);
    sum[i] = 0.0f;
    for (int c = 0; c < 3; ++c) cross[i][c] = 0.0f;
  }
  for (int i = 0; i < kMoments; ++i) moment[i] = 0.0f;

  int n = 0;
  for (int dy = -kRadius; dy <= kRadius; ++dy) {
    for (int dx = -kRadius; dx <= kRadius; ++dx, ++n) {
      const size_t q = w.at(dx, dy);
      const Float weight = load(weights.values[n]) * load(band.valid + q);
      if (!any(weight > 0.0f)) continue;
      Float y[3], x[kGuides];
      for (int c = 0; c < 3; ++c) {
        y[c] = load(half.color[c] + q);
        color[c] += weight * y[c];
      }
      total += weight;
      for (int i = 0; i < kGuides; ++i) x[i] = load(band.guides[i] + q) - origin[i];
      int m = 0;
      for (int i = 0; i < kGuides; ++i) {
        const Float wx = weight * x[i];
        sum[i] += wx;
        for (int c = 0; c < 3; ++c) cross[i][c] += wx * y[c];
        for (int j = i; j < kGuides; ++j) moment[m++] += wx * x[j];
      }
    }
  }

  Fit<kGuides> fit;
  fit.total = total;
  const Float one_over = 1.0f / max(total, 1e-20f);
  for (int c = 0; c < 3; ++c) fit.mean[c] = color[c] * one_over;
  for (int i = 0; i < kGuides; ++i) {
    const Float mean = sum[i] * one_over;
    fit.center[i] = origin[i] + mean;
    for (int c = 0; c < 3; ++c) cross[i][c] = cross[i][c] - mean * color[c];
    for (int j = i; j < kGuides; ++j) moment[place(i, j)] = moment[place(i, j)] - mean * sum[j];
  }
  // Ridge: what a guide's value does not tell, and a little of its own spread, for guides that say the same.
  for (int i = 0; i < kGuides; ++i) {
    Float& m = moment[place(i, i)];
    m = max(m, 0.0f) * 1.001f + total * load(band.guide_variance[i] + p) + 1e-20f;
  }
  // L D L^T, row after row of the upper triangle.
  for (int i = 0; i < kGuides; ++i) {
    const Float inverse = 1.0f / max(moment[place(i, i)], 1e-20f);
    fit.factor[place(i, i)] = inverse;
    for (int j = i + 1; j < kGuides; ++j) fit.factor[place(i, j)] = moment[place(i, j)] * inverse;
    for (int j = i + 1; j < kGuides; ++j) {
      for (int k = j; k < kGuides; ++k)
        moment[place(j, k)] = moment[place(j, k)] - fit.factor[place(i, j)] * moment[place(i, k)];
    }
  }
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < kGuides; ++i) {
      for (int j = i + 1; j < kGuides; ++j) cross[j][c] = cross[j][c] - fit.factor[place(i, j)] * cross[i][c];
    }
    for (int i = kGuides - 1; i >= 0; --i) {
      Float s = cross[i][c] * fit.factor[place(i, i)];
      for (int j = i + 1; j < kGuides; ++j) s = s - fit.factor[place(i, j)] * fit.slope[j][c];
      fit.slope[i][c] = s;
    }
  }
  return fit;
}

/// Adds a fit's values at the pixels dx, dy from the centres, weighted as they were fitted.
template <int kGuides>
GATELIGHT_INLINE void add_value(const Windows& w, const Fit<kGuides>& fit, Float weight, int dx, int dy,
                                const FitView& out) {
  constexpr auto place = Triangle<kGuides>::place;
  const size_t q = w.at(dx, dy);
  Float x[kGuides], value[3];
  for (int c = 0; c < 3; ++c) value[c] = fit.mean[c];
  for (int i = 0; i < kGuides; ++i) {
    x[i] = load(w.band.guides[i] + q) - fit.center[i];
    for (int c = 0; c < 3; ++c) value[c] += fit.slope[i][c] * x[i];
  }
  // The share of a pixel's own samples in its value: weight * (1 / total + x^T M^-1 x).
  Float influence = 1.0f / max(fit.total, 1e-20f);
  for (int i = 0; i < kGuides; ++i) {
    influence += x[i] * x[i] * fit.factor[place(i, i)];
    for (int j = i + 1; j < kGuides; ++j) x[j] = x[j] - fit.factor[place(i, j)] * x[i];
  }
  for (int c = 0; c < 3; ++c) store(out.color[c] + q, load(out.color[c] + q) + weight * value[c]);
  store(out.weight + q, load(out.weight + q) + weight);
  store(out.influence + q, load(out.influence + q) + weight * weight * influence);
}

/// Fits kTogether windows of a row and adds the fits.
template <int kGuides>
GATELIGHT_INLINE void fit_windows(const BandView& band, const Columns& columns, const FitView& out, int y,
                                  int first, int fitted, float bandwidth) {
  constexpr int kRadius = window::kRadius;
  Weights weights[kVectors];
  Fit<kGuides> fits[kVectors];
  for (int v = 0; v < kVectors; ++v) {
    const Windows w{band, columns, y, first + v * kLanes};
    find_weights(w, band.halves[1 - fitted], bandwidth, weights[v]);
    fits[v] = find_fit<kGuides>(w, band.halves[fitted], weights[v]);
  }
  int n = 0;
  for (int dy = -kRadius; dy <= kRadius; ++dy) {
    for (int dx = -kRadius; dx <= kRadius; ++dx, ++n) {
      for (int v = 0; v < kVectors; ++v) {
        const Float weight = load(weights[v].values[n]);
        if (any(weight > 0.0f))
          add_value({band, columns, y, first + v * kLanes}, fits[v], weight, dx, dy, out);
      }
    }
  }
}

}  // namespace

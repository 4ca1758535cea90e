#pragma once
// The inputs besides the features: one-blob and identity encodings of positions, directions,
// normals, albedos and roughness. Part of kernel_table.cpp.

#include "base/simd/fused.h"
#include "base/simd/groups.h"
#include "neural/cpu/kernels.h"

namespace {

using namespace gatelight::neural::cpu;

// The coordinates of a tile's points: as in the batch, by coordinate, and by point.
struct TileCoordinates {
  alignas(64) float raw[3 * kTile + 1];
  alignas(64) float lanes[3][kTile];
  alignas(64) float rows[kTile][4];
};

// atan(a) for a in [0,1]: a polynomial in a^2 fitted at Chebyshev nodes; the error is 1.1e-7 in single
// precision.
GATELIGHT_INLINE Float arctangent_unit(Float a) {
  const float coefficients[9] = {0.999999984f,   -0.333330668f, 0.199924836f,   -0.142025705f, 0.106367541f,
                                 -0.0749544544f, 0.0425876075f, -0.0160050305f, 0.0028340643f};
  const Float z = a * a;
  Float p = coefficients[8];
  for (int i = 7; i >= 0; --i) p = fma(p, z, coefficients[i]);
  return p * a;
}

// atan2(y, x) in (-pi, pi]; 0 for (0, 0).
GATELIGHT_INLINE Float arctangent(Float y, Float x) {
  const Float ax = absolute(x), ay = absolute(y);
  const Float longest = max(ax, ay);
  const Float ratio = min(ax, ay) / max(longest, 1e-37f);
  Float angle = arctangent_unit(ratio);
  angle = select(ax < ay, 1.57079632679f - angle, angle);
  angle = select(x < 0.0f, 3.14159265359f - angle, angle);
  return select(y < 0.0f, 0.0f - angle, angle);
}

// Replaces directions by theta / pi, measured from the z axis, and phi / 2 pi in [0, 1).
GATELIGHT_NOINLINE void spherical(TileCoordinates& tile) {
  for (uint32_t s = 0; s < kTile; s += kLanes) {
    const Float x = load(tile.lanes[0] + s), y = load(tile.lanes[1] + s), z = load(tile.lanes[2] + s);
    const Float theta = arctangent(sqrt(fma(x, x, y * y)), z);
    Float phi = arctangent(y, x) * 0.159154943092f;
    phi = select(phi < 0.0f, phi + 1.0f, phi);
    store(tile.lanes[0] + s, theta * 0.318309886184f);
    store(tile.lanes[1] + s, phi);
  }
}

GATELIGHT_INLINE const float* span_of(const KernelPoints& points, KernelSource source) {
  const float* const spans[] = {points.positions, points.directions, points.normals, points.albedos,
                                points.roughnesses};
  return spans[static_cast<uint32_t>(source)];
}

// Integral of the quartic kernel 15/16 (1 - u^2)^2 from -1 to u; between 0 and 1.
GATELIGHT_INLINE Float quartic_primitive(Float u) {
  u = clamp(u, -1.0f, 1.0f);
  const Float z = u * u;
  const Float p = fma(fma(z, 0.2f, -2.0f / 3.0f), z, 1.0f);
  return fma(u * (15.0f / 16.0f), p, 0.5f);
}

// The part of a kernel of radius 1/size inside a bin whose centre has this distance from the kernel's.
GATELIGHT_INLINE Float bin_share(Float distance, float size) {
  return quartic_primitive(fma(distance, size, 0.5f)) - quartic_primitive(fma(distance, size, -0.5f));
}

// One-blob (Mueller et al. 2019, 2021): each bin holds the part of a quartic kernel of radius 1/size around
// the coordinate. A lane is a bin. The azimuth (the second spherical coordinate) wraps.
GATELIGHT_NOINLINE void encode_one_blob(const KernelAuxiliary& a, const TileCoordinates& tile, float* inputs,
                                        uint32_t stride) {
  const bool wraps = a.transform == KernelTransform::spherical_one_blob;
  const float size = static_cast<float>(a.size);
  const int log2_size = __builtin_ctz(a.size);
  for (uint32_t first_bin = 0; first_bin < a.inputs; first_bin += kLanes) {
    const Int lane = lane_numbers() + first_bin;
    const Int coordinate = lane >> log2_size;
    const Float center = (to_float(lane & (a.size - 1u)) + 0.5f) * (1.0f / size);
    const Float wrap = wraps ? select_or_zero(coordinate == 1u, Float(1.0f)) : Float(0.0f);
    const uint32_t count = a.inputs - first_bin;
    float* row = inputs + a.first_input + first_bin;
    const Int picked = coordinate & 3u;
    for (uint32_t s = 0; s < kTile; ++s, row += stride) {
      Float distance = center - pick4(tile.rows[s], picked);
      distance -= wrap * round(distance);
      Float share = bin_share(distance, size);
      // With two bins on a circle the kernel reaches a bin from both sides.
      if (wraps && a.size == 2)
        share = fma(wrap, bin_share(distance + wrap, size) + bin_share(distance - wrap, size), share);
      if (count >= kLanes) {
        store(row, share);
      } else {
        store_partial(row, share, count);
      }
    }
  }
}

// Fills the auxiliary columns of all kTile rows of inputs. Invalid and missing points count as zeros. `last`
// means that memory behind these points must not be read.
GATELIGHT_NOINLINE void encode_auxiliary(const KernelEncoder& e, const KernelPoints& points, uint64_t begin,
                                         uint32_t count, bool last, const float* valid, float* inputs,
                                         uint32_t stride) {
  TileCoordinates tile;
  for (uint32_t i = 0; i < e.auxiliary_count; ++i) {
    const KernelAuxiliary& a = e.auxiliary[i];
    const uint32_t width = a.source == KernelSource::roughness ? 1 : 3;
    const float* rows = span_of(points, a.source) + begin * width;
    if (last || count < kTile) {
      for (uint32_t k = 0; k < kTile * width; ++k) tile.raw[k] = k < count * width ? rows[k] : 0.0f;
      rows = tile.raw;
    }
    for (uint32_t s = 0; s < kTile; s += kLanes) {
      const Mask usable = load(valid + s) > 0.0f;
      Float4 columns;
      if (width == 1)
        columns.c[0] = load(rows + s);
      else
        columns =
            load_columns4([&](uint32_t l) __attribute__((always_inline)) { return rows + (s + l) * 3; });
      for (uint32_t c = 0; c < width; ++c) {
        Float x = select_or_zero(usable, columns.c[c]);
        if (a.source == KernelSource::position)
          x = clamp((x - e.bounds_min[c]) * e.inverse_extent, 0.0f, 1.0f);
        store(tile.lanes[c] + s, x);
      }
    }
    if (a.transform == KernelTransform::spherical_one_blob) spherical(tile);
    for (uint32_t s = 0; s < kTile; ++s)
      for (uint32_t c = 0; c < a.coordinates; ++c) tile.rows[s][c] = tile.lanes[c][s];
    if (a.transform == KernelTransform::identity) {
      for (uint32_t s = 0; s < kTile; ++s)
        for (uint32_t c = 0; c < a.coordinates; ++c) inputs[s * stride + a.first_input + c] = tile.rows[s][c];
    } else {
      encode_one_blob(a, tile, inputs, stride);
    }
  }
}

}  // namespace

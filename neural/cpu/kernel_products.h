#pragma once
// The three matrix products of a layer, all in one pattern: kBlockRows x kBlockVectors accumulators add a
// broadcast from the left matrix times vectors of the right one. The left matrix is a tile's activations
// (records in rows) or, for weight gradients, their transpose. Nothing is transposed in memory. Part of
// kernel_table.cpp.

#include "base/simd/fused.h"
#include "neural/cpu/kernel_prefetch.h"

namespace {

// A block of kBlockRows x kBlockVectors accumulators takes 24 of AVX-512's 32 registers, or 12 of 16, and
// leaves the others for operands.
constexpr uint32_t kBlockRows = kLanes == 16 ? 12 : 6;
constexpr uint32_t kBlockVectors = 2;

/// A number as a type, for lambdas that need a compile-time constant.
template <uint32_t kValue>
struct Constant {
  static constexpr uint32_t value = kValue;
};

struct NoSums {
  __attribute__((always_inline)) void operator()(uint32_t, Float) const {}
};

// acc[r][v] += sum over d of x[r * kRowStride + d * depth_stride] * w[d * w_stride + v * kLanes]. Calls
// see(v, vector) for each vector of w.
template <uint32_t kRows, uint32_t kVectors, uint32_t kRowStride, class See = NoSums>
GATELIGHT_INLINE void accumulate(Float (&acc)[kRows][kVectors], const float* x, uint32_t depth_stride,
                                 const float* w, uint32_t w_stride, uint32_t depth, See&& see = {}) {
#pragma GCC unroll 4
  for (uint32_t d = 0; d < depth; ++d, x += depth_stride, w += w_stride) {
    Float column[kVectors];
#pragma GCC unroll 4
    for (uint32_t v = 0; v < kVectors; ++v) {
      column[v] = load(w + v * kLanes);
      see(v, column[v]);
    }
#pragma GCC unroll 16
    for (uint32_t r = 0; r < kRows; ++r) {
      const Float a = x[r * kRowStride];
#pragma GCC unroll 4
      for (uint32_t v = 0; v < kVectors; ++v) acc[r][v] = fma(a, column[v], acc[r][v]);
    }
  }
}

#if defined(__AVX512BF16__)

// The same with pairs of bf16 numbers along the depth; their products are summed in fp32 (vdpbf16ps).
template <uint32_t kRows, uint32_t kVectors, uint32_t kRowStride>
GATELIGHT_INLINE void accumulate(Float (&acc)[kRows][kVectors], const uint16_t* x, uint32_t depth_stride,
                                 const uint16_t* w, uint32_t w_stride, uint32_t depth) {
  for (uint32_t d = 0; d < depth; ++d, x += depth_stride, w += w_stride) {
    __m512bh column[kVectors];
#pragma GCC unroll 4
    for (uint32_t v = 0; v < kVectors; ++v) __builtin_memcpy(&column[v], w + v * 2 * kLanes, 64);
#pragma GCC unroll 16
    for (uint32_t r = 0; r < kRows; ++r) {
      uint32_t pair;
      __builtin_memcpy(&pair, x + r * kRowStride, 4);
      const auto a = __builtin_bit_cast(__m512bh, Int(pair).v);
#pragma GCC unroll 4
      for (uint32_t v = 0; v < kVectors; ++v) acc[r][v] = _mm512_dpbf16_ps(acc[r][v].v, a, column[v]);
    }
  }
}

#endif

// Number of elements, floats or bf16 numbers, that fill a float's place along the depth.
template <class Element>
constexpr uint32_t kPack = sizeof(float) / sizeof(Element);

// Computes y = x w (+ bias) for `rows` rows, a multiple of kBlockRows; `depth` counts packs. Calls
// finish(row, column, value) to store a vector and between_blocks() after each block.
template <uint32_t kRowStride, uint32_t kVectors, class Element, class Finish>
GATELIGHT_NOINLINE void multiply_block_columns(const Element* x, uint32_t rows, uint32_t depth,
                                               const Element* w, uint32_t w_stride, const float* bias,
                                               uint32_t columns, Finish&& finish,
                                               const Between& between_blocks) {
  for (uint32_t c = 0; c < columns; c += kVectors * kLanes) {
    Float start[kVectors];
#pragma GCC unroll 4
    for (uint32_t v = 0; v < kVectors; ++v)
      start[v] = bias != nullptr ? load(bias + c + v * kLanes) : Float(0.0f);
    for (uint32_t r0 = 0; r0 < rows; r0 += kBlockRows) {
      Float acc[kBlockRows][kVectors];
#pragma GCC unroll 16
      for (uint32_t r = 0; r < kBlockRows; ++r)
#pragma GCC unroll 4
        for (uint32_t v = 0; v < kVectors; ++v) acc[r][v] = start[v];
      accumulate<kBlockRows, kVectors, kRowStride>(acc, x + r0 * kRowStride, kPack<Element>,
                                                   w + kPack<Element> * c, kPack<Element> * w_stride, depth);
#pragma GCC unroll 16
      for (uint32_t r = 0; r < kBlockRows; ++r)
#pragma GCC unroll 4
        for (uint32_t v = 0; v < kVectors; ++v) finish(r0 + r, c + v * kLanes, acc[r][v]);
      between_blocks();
    }
  }
}

// `columns` is a multiple of 16. The last columns use one vector per row if two do not fit.
template <uint32_t kRowStride, class Element, class Finish>
GATELIGHT_INLINE void multiply(const Element* x, uint32_t rows, uint32_t depth, const Element* w,
                               uint32_t w_stride, const float* bias, uint32_t columns, Finish&& finish,
                               const Between& between_blocks) {
  const uint32_t pairs = columns / (kBlockVectors * kLanes) * (kBlockVectors * kLanes);
  multiply_block_columns<kRowStride, kBlockVectors>(x, rows, depth, w, w_stride, bias, pairs, finish,
                                                    between_blocks);
  if (pairs < columns)
    multiply_block_columns<kRowStride, 1>(
        x, rows, depth, w + kPack<Element> * pairs, w_stride, bias != nullptr ? bias + pairs : nullptr,
        columns - pairs,
        [&](uint32_t r, uint32_t c, Float a) __attribute__((always_inline)) { finish(r, c + pairs, a); },
        between_blocks);
}

// g[i][c] += sum over s of x[s][i] d[s][c] for i in [0, kRows). With kSums also sums[c] += sum over s of
// d[s][c]; these additions cost nothing beside the multiply-adds.
template <uint32_t kRows, uint32_t kVectors, bool kSums>
GATELIGHT_NOINLINE void add_outer_block(float* g, uint32_t g_stride, const float* x, uint32_t x_stride,
                                        const float* d, uint32_t d_stride, uint32_t samples, float* sums) {
  Float acc[kRows][kVectors];
#pragma GCC unroll 16
  for (uint32_t r = 0; r < kRows; ++r)
#pragma GCC unroll 4
    for (uint32_t v = 0; v < kVectors; ++v) acc[r][v] = load(g + r * g_stride + v * kLanes);
  if constexpr (kSums) {
    Float total[kVectors];
#pragma GCC unroll 4
    for (uint32_t v = 0; v < kVectors; ++v) total[v] = load(sums + v * kLanes);
    accumulate<kRows, kVectors, 1>(
        acc, x, x_stride, d, d_stride,
        samples, [&](uint32_t v, Float column) __attribute__((always_inline)) { total[v] += column; });
#pragma GCC unroll 4
    for (uint32_t v = 0; v < kVectors; ++v) store(sums + v * kLanes, total[v]);
  } else {
    accumulate<kRows, kVectors, 1>(acc, x, x_stride, d, d_stride, samples);
  }
#pragma GCC unroll 16
  for (uint32_t r = 0; r < kRows; ++r)
#pragma GCC unroll 4
    for (uint32_t v = 0; v < kVectors; ++v) store(g + r * g_stride + v * kLanes, acc[r][v]);
}

// Adds weight gradients: g[i][c] += sum over samples s of x[s][i] d[s][c] for i < rows and c < columns (a
// multiple of 16). Adds bias gradients: sums[c] += sum over s of d[s][c].
GATELIGHT_NOINLINE void add_outer(float* g, uint32_t g_stride, const float* x, uint32_t x_stride,
                                  uint32_t rows, const float* d, uint32_t d_stride, uint32_t columns,
                                  uint32_t samples, float* sums, const Between& between_blocks) {
  constexpr uint32_t kPair = kBlockVectors * kLanes;
  const auto sweep = [&](auto size, auto summed, uint32_t i) __attribute__((always_inline)) {
    constexpr uint32_t kRows = decltype(size)::value;
    constexpr bool kSums = decltype(summed)::value != 0;
    uint32_t c = 0;
    for (; c + kPair <= columns; c += kPair)
      add_outer_block<kRows, kBlockVectors, kSums>(g + i * g_stride + c, g_stride, x + i, x_stride, d + c,
                                                   d_stride, samples, sums + c);
    for (; c < columns; c += kLanes)
      add_outer_block<kRows, 1, kSums>(g + i * g_stride + c, g_stride, x + i, x_stride, d + c, d_stride,
                                       samples, sums + c);
    between_blocks();
    return i + kRows;
  };
  const auto next = [&](uint32_t left, auto summed, uint32_t i) __attribute__((always_inline)) {
    if (left >= kBlockRows) return sweep(Constant<kBlockRows>{}, summed, i);
    if (left >= 8 && kBlockRows > 8) return sweep(Constant<8>{}, summed, i);
    if (left >= 4) return sweep(Constant<4>{}, summed, i);
    if (left >= 2) return sweep(Constant<2>{}, summed, i);
    return sweep(Constant<1>{}, summed, i);
  };
  uint32_t i = rows > 0 ? next(rows, Constant<1>{}, 0) : 0;
  while (i < rows) i = next(rows - i, Constant<0>{}, i);
}

}  // namespace

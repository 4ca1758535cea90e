#pragma once
// Vectors of 8, 4, 2 or 1 floats for feature vectors and their parts, loaded from floats or halves. The
// compiler maps them to the instruction set. Part of kernel_table.cpp.

#include "base/simd/vectors.h"

#if !defined(__F16C__)
#include "base/half.h"
#endif

namespace {

typedef float Short8 __attribute__((vector_size(32)));
typedef float Short4 __attribute__((vector_size(16)));

// Two floats in the lower half of four, because gcc 12 moves vectors of eight bytes through memory.
struct Short2 {
  Short4 v;
};
GATELIGHT_INLINE Short2 operator+(Short2 a, Short2 b) {
  return {a.v + b.v};
}
GATELIGHT_INLINE Short2 operator-(Short2 a, Short2 b) {
  return {a.v - b.v};
}
GATELIGHT_INLINE Short2 operator*(Short2 a, Short2 b) {
  return {a.v * b.v};
}
GATELIGHT_INLINE Short2 operator/(Short2 a, Short2 b) {
  return {a.v / b.v};
}
GATELIGHT_INLINE Short2 operator*(Short2 a, float b) {
  return {a.v * b};
}
GATELIGHT_INLINE Short2 operator+(Short2 a, float b) {
  return {a.v + b};
}

/// Number of floats in a V.
template <class V>
constexpr uint32_t kShort = sizeof(V) / 4;
template <>
constexpr uint32_t kShort<Short2> = 2;

template <class V>
GATELIGHT_INLINE V load_short(const float* p) {
  V v;
  if constexpr (__is_same(V, Short2)) {
    typedef long long Pair __attribute__((vector_size(16)));
    long long both_floats;
    __builtin_memcpy(&both_floats, p, 8);
    v.v = (Short4)Pair{both_floats, 0};
  } else {
    __builtin_memcpy(&v, p, sizeof v);
  }
  return v;
}
template <class V>
GATELIGHT_INLINE void store_short(float* p, V v) {
  if constexpr (__is_same(V, Short2)) {
    typedef long long Pair __attribute__((vector_size(16)));
    const long long both_floats = ((Pair)v.v)[0];
    __builtin_memcpy(p, &both_floats, 8);
  } else {
    __builtin_memcpy(p, &v, sizeof v);
  }
}
/// Lane i of v.
template <class V>
GATELIGHT_INLINE float lane_of(const V& v, uint32_t i) {
  if constexpr (__is_same(V, Short2))
    return v.v[i];
  else if constexpr (__is_same(V, float))
    return v;
  else
    return v[i];
}

#if !defined(__F16C__)

template <class V>
GATELIGHT_INLINE V load_short(const uint16_t* p) {
  float lanes[kShort<V>];
  for (uint32_t i = 0; i < kShort<V>; ++i) lanes[i] = gatelight::half_to_float(p[i]);
  return load_short<V>(lanes);
}
template <class V>
GATELIGHT_INLINE void store_short(uint16_t* p, V v) {
  for (uint32_t i = 0; i < kShort<V>; ++i) p[i] = gatelight::float_to_half(lane_of(v, i));
}
template <class V>
GATELIGHT_INLINE V sqrt_short(V v) {
  float lanes[kShort<V>];
  for (uint32_t i = 0; i < kShort<V>; ++i) lanes[i] = __builtin_sqrtf(lane_of(v, i));
  return load_short<V>(lanes);
}

#else

template <class V>
GATELIGHT_INLINE V load_short(const uint16_t* p) {
  if constexpr (sizeof(V) == 32) {
    return (V)_mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)));
  } else {
    long long word = 0;
    __builtin_memcpy(&word, p, 2 * kShort<V>);
    const __m128 x = _mm_cvtph_ps(_mm_cvtsi64_si128(word));
    V v;
    __builtin_memcpy(&v, &x, sizeof v);
    return v;
  }
}
template <class V>
GATELIGHT_INLINE void store_short(uint16_t* p, V v) {
  if constexpr (sizeof(V) == 32) {
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm256_cvtps_ph((__m256)v, _MM_FROUND_TO_NEAREST_INT));
  } else {
    __m128 x = _mm_setzero_ps();
    __builtin_memcpy(&x, &v, sizeof v);
    const long long word = _mm_cvtsi128_si64(_mm_cvtps_ph(x, _MM_FROUND_TO_NEAREST_INT));
    __builtin_memcpy(p, &word, 2 * kShort<V>);
  }
}
template <class V>
GATELIGHT_INLINE V sqrt_short(V v) {
  if constexpr (sizeof(V) == 32) {
    return (V)_mm256_sqrt_ps((__m256)v);
  } else {
    __m128 x = _mm_setzero_ps();
    __builtin_memcpy(&x, &v, sizeof v);
    x = _mm_sqrt_ps(x);
    __builtin_memcpy(&v, &x, sizeof v);
    return v;
  }
}

#endif

/// Calls part(zeros, offset) for the parts of `count` floats: as many eights as fit, then four, two and one.
/// The zeros have the type of the part.
template <class F>
GATELIGHT_INLINE void for_parts(uint32_t count, F&& part) {
  uint32_t at = 0;
  for (; at + 8 <= count; at += 8) part(Short8{}, at);
  if (at + 4 <= count) {
    part(Short4{}, at);
    at += 4;
  }
  if (at + 2 <= count) {
    part(Short2{}, at);
    at += 2;
  }
  if (at < count) part(0.0f, at);
}

}  // namespace

#pragma once
// Operations whose last bit depends on the instruction set: it decides how often a result is rounded, or in
// which order lanes are added. Only kernel sources include this file (vectors.h), and those that must give
// the same bits everywhere do not.

#include "base/simd/vectors.h"

namespace {

/// a * b + c: rounded once by AVX2 and AVX-512, twice by others.
GATELIGHT_INLINE Float fma(Float a, Float b, Float c) {
#if defined(__FMA__)
  return GATELIGHT_SIMD(fmadd_ps)(a.v, b.v, c.v);
#else
  return a * b + c;
#endif
}
/// The sum of all lanes.
GATELIGHT_INLINE float sum(Float a) {
#if defined(__AVX512F__)
  return _mm512_reduce_add_ps(a.v);
#elif defined(__AVX2__)
  __m128 x = _mm_add_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
  x = _mm_add_ps(x, _mm_movehl_ps(x, x));
  return _mm_cvtss_f32(_mm_add_ss(x, _mm_movehdup_ps(x)));
#else
  return (a.v[0] + a.v[2]) + (a.v[1] + a.v[3]);
#endif
}
/// Stores the sum of the groups of four lanes.
GATELIGHT_INLINE void store_sum4(float* p, Float a) {
#if defined(__AVX512F__)
  const __m256 half = _mm256_add_ps(_mm512_castps512_ps256(a.v), _mm512_extractf32x8_ps(a.v, 1));
  _mm_storeu_ps(p, _mm_add_ps(_mm256_castps256_ps128(half), _mm256_extractf128_ps(half, 1)));
#elif defined(__AVX2__)
  _mm_storeu_ps(p, _mm_add_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1)));
#else
  store(p, a);
#endif
}

}  // namespace

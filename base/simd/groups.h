#pragma once
// Groups of four lanes: records of four numbers in memory, and vectors that hold a number of each. Only
// kernel sources include this file (vectors.h).

#include "base/simd/vectors.h"

namespace {

/// Four numbers for each lane, as four vectors.
struct Float4 {
  Float c[4];
};

/// Four vectors hold four numbers for each of kLanes / 4 lanes: vector j those of the lanes j, j + 4, j + 8
/// ... This sorts them by number.
GATELIGHT_INLINE Float4 transpose4(Float r0, Float r1, Float r2, Float r3) {
#if defined(__AVX2__)
  const auto low = [](Float a, Float b) __attribute__((always_inline)) {
    return GATELIGHT_SIMD(unpacklo_ps)(a.v, b.v);
  };
  const auto high = [](Float a, Float b) __attribute__((always_inline)) {
    return GATELIGHT_SIMD(unpackhi_ps)(a.v, b.v);
  };
  const auto join_low = [](FloatRegister a, FloatRegister b) __attribute__((always_inline)) {
    return Float((FloatRegister)GATELIGHT_SIMD(unpacklo_epi64)((IntRegister)a, (IntRegister)b));
  };
  const auto join_high = [](FloatRegister a, FloatRegister b) __attribute__((always_inline)) {
    return Float((FloatRegister)GATELIGHT_SIMD(unpackhi_epi64)((IntRegister)a, (IntRegister)b));
  };
#else
  const auto low = [](Float a, Float b) __attribute__((always_inline)) {
    return __builtin_shufflevector(a.v, b.v, 0, 4, 1, 5);
  };
  const auto high = [](Float a, Float b) __attribute__((always_inline)) {
    return __builtin_shufflevector(a.v, b.v, 2, 6, 3, 7);
  };
  const auto join_low = [](FloatRegister a, FloatRegister b) __attribute__((always_inline)) {
    return Float(__builtin_shufflevector(a, b, 0, 1, 4, 5));
  };
  const auto join_high = [](FloatRegister a, FloatRegister b) __attribute__((always_inline)) {
    return Float(__builtin_shufflevector(a, b, 2, 3, 6, 7));
  };
#endif
  const FloatRegister a = low(r0, r1), b = low(r2, r3), c = high(r0, r1), d = high(r2, r3);
  return {{join_low(a, b), join_high(a, b), join_low(c, d), join_high(c, d)}};
}

/// Four numbers from each of kLanes / 4 addresses: address(0), address(1) ... of floats or words.
template <class Address>
GATELIGHT_INLINE Float load_groups4(Address address) {
  const auto group = [&](int k) __attribute__((always_inline)) {
    return reinterpret_cast<const float*>(address(k));
  };
#if defined(__AVX512F__)
  __m512 r = _mm512_castps128_ps512(_mm_loadu_ps(group(0)));
  r = _mm512_insertf32x4(r, _mm_loadu_ps(group(1)), 1);
  r = _mm512_insertf32x4(r, _mm_loadu_ps(group(2)), 2);
  return _mm512_insertf32x4(r, _mm_loadu_ps(group(3)), 3);
#elif defined(__AVX2__)
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(group(0))), _mm_loadu_ps(group(1)), 1);
#else
  return load(group(0));
#endif
}
/// Four numbers from each of kLanes addresses, whose types are as above: c[i] of lane l is address(l)[i]. It
/// makes a quarter of the reads of four gathers.
template <class Address>
GATELIGHT_INLINE Float4 load_columns4(Address address) {
  const auto row = [&](int j) __attribute__((always_inline)) {
    return load_groups4([&](int k) __attribute__((always_inline)) { return address(j + 4 * k); });
  };
  return transpose4(row(0), row(1), row(2), row(3));
}
/// One number from each of kLanes / 4 addresses, each four times.
template <class Address>
GATELIGHT_INLINE Float repeat_groups4(Address address) {
#if defined(__AVX512F__)
  __m512 r = _mm512_castps128_ps512(_mm_load_ps1(address(0)));
  r = _mm512_insertf32x4(r, _mm_load_ps1(address(1)), 1);
  r = _mm512_insertf32x4(r, _mm_load_ps1(address(2)), 2);
  return _mm512_insertf32x4(r, _mm_load_ps1(address(3)), 3);
#elif defined(__AVX2__)
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps1(address(0))), _mm_load_ps1(address(1)), 1);
#else
  return *address(0);
#endif
}

/// Indices in memory, for several reads of the same records.
struct Records {
  alignas(64) uint32_t first[kLanes];  ///< number of a record's first float

  GATELIGHT_INLINE explicit Records(Int i) { store(first, i); }
  /// The four floats or words at p[first + offset] of each lane.
  template <class Number>
  GATELIGHT_INLINE Float4 four(const Number* p, uint32_t offset) const {
    return load_columns4([&](int l) __attribute__((always_inline)) { return p + offset + first[l]; });
  }
};

/// Lane l takes p[i[l]], i in 0..3.
GATELIGHT_INLINE Float pick4(const float* p, Int i) {
#if defined(__AVX512F__)
  return _mm512_permutevar_ps(_mm512_broadcast_f32x4(_mm_loadu_ps(p)), (IntRegister)i.v);
#elif defined(__AVX2__)
  return _mm256_permutevar_ps(_mm256_broadcast_ps(reinterpret_cast<const __m128*>(p)), (IntRegister)i.v);
#else
  return gather(p, i);
#endif
}
/// Copies lane kLane of each group to the whole group.
template <int kLane>
GATELIGHT_INLINE Float repeat4(Float a) {
#if defined(__AVX2__)
  return GATELIGHT_SIMD(permute_ps)(a.v, kLane * 0x55);
#else
  return __builtin_shufflevector(a.v, a.v, kLane, kLane, kLane, kLane);
#endif
}
/// The first group, and zeros.
GATELIGHT_INLINE Float load_first4(const float* p) {
#if defined(__AVX512F__)
  return _mm512_zextps128_ps512(_mm_loadu_ps(p));
#elif defined(__AVX2__)
  return _mm256_zextps128_ps256(_mm_loadu_ps(p));
#else
  return load(p);
#endif
}

}  // namespace

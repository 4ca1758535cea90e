#pragma once
// The vectors of the kernels: the same names for scalar code, AVX2 and AVX-512. Only kernel_table.cpp
// includes this file; it is compiled once for each instruction set with GATELIGHT_ISA_SCALAR, _AVX2 or
// _AVX512 defined. Everything is internal to that object file, so the linker cannot mix the symbols of
// instruction sets.

#include <stdint.h>

#if !defined(GATELIGHT_ISA_SCALAR)
#include <immintrin.h>
#endif

#define GATELIGHT_INLINE static inline __attribute__((always_inline))
// For loops that need all registers. If they are inlined, gcc keeps the caller's constants in registers
// across them and spills an operand in each step (a third slower).
#define GATELIGHT_ALONE static __attribute__((noinline))

namespace {

#if defined(GATELIGHT_ISA_AVX512)

constexpr uint32_t kLanes = 16;
// A block of kBlockRows x kBlockVectors accumulators takes 24 of 32 registers and leaves the others for
// operands.
constexpr uint32_t kBlockRows = 12;
constexpr uint32_t kBlockVectors = 2;
using Float = __m512;
using Int = __m512i;
using Mask = __mmask16;

GATELIGHT_INLINE Float load(const float* p) {
  return _mm512_loadu_ps(p);
}
GATELIGHT_INLINE void store(float* p, Float a) {
  _mm512_storeu_ps(p, a);
}
GATELIGHT_INLINE __mmask16 first(uint32_t count) {
  return static_cast<__mmask16>(count >= 16 ? 0xffffu : (1u << count) - 1u);
}
GATELIGHT_INLINE Float load_partial(const float* p, uint32_t count) {
  return _mm512_maskz_loadu_ps(first(count), p);
}
GATELIGHT_INLINE void store_partial(float* p, Float a, uint32_t count) {
  _mm512_mask_storeu_ps(p, first(count), a);
}
GATELIGHT_INLINE Float broadcast(float a) {
  return _mm512_set1_ps(a);
}
GATELIGHT_INLINE Float zero() {
  return _mm512_setzero_ps();
}
GATELIGHT_INLINE Float add(Float a, Float b) {
  return _mm512_add_ps(a, b);
}
GATELIGHT_INLINE Float sub(Float a, Float b) {
  return _mm512_sub_ps(a, b);
}
GATELIGHT_INLINE Float mul(Float a, Float b) {
  return _mm512_mul_ps(a, b);
}
GATELIGHT_INLINE Float div(Float a, Float b) {
  return _mm512_div_ps(a, b);
}
GATELIGHT_INLINE Float fma(Float a, Float b, Float c) {
  return _mm512_fmadd_ps(a, b, c);
}
GATELIGHT_INLINE Float min(Float a, Float b) {
  return _mm512_min_ps(a, b);
}
GATELIGHT_INLINE Float max(Float a, Float b) {
  return _mm512_max_ps(a, b);
}
GATELIGHT_INLINE Float sqrt(Float a) {
  return _mm512_sqrt_ps(a);
}
GATELIGHT_INLINE Float floor(Float a) {
  return _mm512_roundscale_ps(a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}
GATELIGHT_INLINE Float round(Float a) {
  return _mm512_roundscale_ps(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
GATELIGHT_INLINE Float select(Mask m, Float a, Float b) {
  return _mm512_mask_blend_ps(m, b, a);
}
GATELIGHT_INLINE Mask less(Float a, Float b) {
  return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ);
}
GATELIGHT_INLINE Mask equal(Float a, Float b) {
  return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ);
}
GATELIGHT_INLINE Mask both(Mask a, Mask b) {
  return static_cast<Mask>(a & b);
}
GATELIGHT_INLINE Mask either(Mask a, Mask b) {
  return static_cast<Mask>(a | b);
}
GATELIGHT_INLINE uint32_t bits(Mask m) {
  return m;
}
GATELIGHT_INLINE Float gather(const float* p, Int i) {
  return _mm512_i32gather_ps(i, p, 4);
}
/// Lane l takes p[i[l]], i in 0..3.
GATELIGHT_INLINE Float pick4(const float* p, Int i) {
  return _mm512_permutevar_ps(_mm512_broadcast_f32x4(_mm_loadu_ps(p)), i);
}
GATELIGHT_INLINE float sum(Float a) {
  return _mm512_reduce_add_ps(a);
}
/// Copies lane kLane of each group of four lanes to the whole group.
template <int kLane>
GATELIGHT_INLINE Float repeat4(Float a) {
  return _mm512_permute_ps(a, kLane * 0x55);
}
/// Stores the sum of the groups of four lanes.
GATELIGHT_INLINE void store_sum4(float* p, Float a) {
  const __m256 half = _mm256_add_ps(_mm512_castps512_ps256(a), _mm512_extractf32x8_ps(a, 1));
  _mm_storeu_ps(p, _mm_add_ps(_mm256_castps256_ps128(half), _mm256_extractf128_ps(half, 1)));
}
GATELIGHT_INLINE Float load_first4(const float* p) {
  return _mm512_zextps128_ps512(_mm_loadu_ps(p));
}

GATELIGHT_INLINE Int load_int(const uint32_t* p) {
  return _mm512_loadu_si512(p);
}
GATELIGHT_INLINE void store_int(uint32_t* p, Int a) {
  _mm512_storeu_si512(p, a);
}
GATELIGHT_INLINE Int broadcast_int(uint32_t a) {
  return _mm512_set1_epi32(static_cast<int>(a));
}
GATELIGHT_INLINE Int lane_numbers() {
  return _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
GATELIGHT_INLINE Int add_int(Int a, Int b) {
  return _mm512_add_epi32(a, b);
}
GATELIGHT_INLINE Int sub_int(Int a, Int b) {
  return _mm512_sub_epi32(a, b);
}
GATELIGHT_INLINE Int mul_int(Int a, Int b) {
  return _mm512_mullo_epi32(a, b);
}
GATELIGHT_INLINE Int xor_int(Int a, Int b) {
  return _mm512_xor_si512(a, b);
}
GATELIGHT_INLINE Int half_int(Int a) {
  return _mm512_srli_epi32(a, 1);
}
GATELIGHT_INLINE Int select_int(Mask m, Int a, Int b) {
  return _mm512_mask_blend_epi32(m, b, a);
}
GATELIGHT_INLINE Mask equal_int(Int a, Int b) {
  return _mm512_cmpeq_epi32_mask(a, b);
}
GATELIGHT_INLINE Mask less_unsigned(Int a, Int b) {
  return _mm512_cmplt_epu32_mask(a, b);
}
GATELIGHT_INLINE Int gather_int(const uint32_t* p, Int i) {
  return _mm512_i32gather_epi32(i, p, 4);
}
GATELIGHT_INLINE Int and_int(Int a, Int b) {
  return _mm512_and_si512(a, b);
}
GATELIGHT_INLINE Int shift_right(Int a, uint32_t n) {
  return _mm512_srl_epi32(a, _mm_cvtsi32_si128(static_cast<int>(n)));
}
/// The upper half of the product of 32-bit numbers.
GATELIGHT_INLINE Int multiply_high(Int a, Int b) {
  const Int even = _mm512_srli_epi64(_mm512_mul_epu32(a, b), 32);
  const Int odd = _mm512_mul_epu32(_mm512_srli_epi64(a, 32), b);
  return _mm512_mask_blend_epi32(0xaaaa, even, odd);
}
GATELIGHT_INLINE uint32_t first_lane(Int a) {
  return static_cast<uint32_t>(_mm_cvtsi128_si32(_mm512_castsi512_si128(a)));
}
GATELIGHT_INLINE Int bits_of(Float a) {
  return _mm512_castps_si512(a);
}
GATELIGHT_INLINE Float float_of(Int a) {
  return _mm512_castsi512_ps(a);
}
GATELIGHT_INLINE Int to_int(Float a) {
  return _mm512_cvttps_epi32(a);
}
GATELIGHT_INLINE Float to_float(Int a) {
  return _mm512_cvtepi32_ps(a);
}

/// Loads four words from each of kLanes addresses: lane l of column c is address(l)[c].
template <class Address>
GATELIGHT_INLINE void load_columns4(Address address, Int (&columns)[4]) {
  __m512i rows[4];
#pragma GCC unroll 4
  for (uint32_t j = 0; j < 4; ++j) {
    const auto part = [&](uint32_t l) __attribute__((always_inline)) {
      return _mm_loadu_si128(reinterpret_cast<const __m128i*>(address(l)));
    };
    __m512i r = _mm512_castsi128_si512(part(j));
    r = _mm512_inserti32x4(r, part(j + 4), 1);
    r = _mm512_inserti32x4(r, part(j + 8), 2);
    rows[j] = _mm512_inserti32x4(r, part(j + 12), 3);
  }
  const __m512i low01 = _mm512_unpacklo_epi32(rows[0], rows[1]),
                high01 = _mm512_unpackhi_epi32(rows[0], rows[1]);
  const __m512i low23 = _mm512_unpacklo_epi32(rows[2], rows[3]),
                high23 = _mm512_unpackhi_epi32(rows[2], rows[3]);
  columns[0] = _mm512_unpacklo_epi64(low01, low23);
  columns[1] = _mm512_unpackhi_epi64(low01, low23);
  columns[2] = _mm512_unpacklo_epi64(high01, high23);
  columns[3] = _mm512_unpackhi_epi64(high01, high23);
}
/// Separates consecutive pairs: first[l] = p[2 l], second[l] = p[2 l + 1].
GATELIGHT_INLINE void load_pairs(const float* p, Float& first, Float& second) {
  const __m512i even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
  const __m512 a = _mm512_loadu_ps(p), b = _mm512_loadu_ps(p + 16);
  first = _mm512_permutex2var_ps(a, even, b);
  second = _mm512_permutex2var_ps(a, _mm512_add_epi32(even, _mm512_set1_epi32(1)), b);
}

#elif defined(GATELIGHT_ISA_AVX2)

constexpr uint32_t kLanes = 8;
constexpr uint32_t kBlockRows = 6;
constexpr uint32_t kBlockVectors = 2;
using Float = __m256;
using Int = __m256i;
struct Mask {
  __m256i m;
};

GATELIGHT_INLINE Int lane_numbers() {
  return _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
}
GATELIGHT_INLINE __m256i first(uint32_t count) {
  return _mm256_cmpgt_epi32(_mm256_set1_epi32(static_cast<int>(count)), lane_numbers());
}
GATELIGHT_INLINE Float load(const float* p) {
  return _mm256_loadu_ps(p);
}
GATELIGHT_INLINE void store(float* p, Float a) {
  _mm256_storeu_ps(p, a);
}
GATELIGHT_INLINE Float load_partial(const float* p, uint32_t count) {
  return _mm256_maskload_ps(p, first(count));
}
GATELIGHT_INLINE void store_partial(float* p, Float a, uint32_t count) {
  _mm256_maskstore_ps(p, first(count), a);
}
GATELIGHT_INLINE Float broadcast(float a) {
  return _mm256_set1_ps(a);
}
GATELIGHT_INLINE Float zero() {
  return _mm256_setzero_ps();
}
GATELIGHT_INLINE Float add(Float a, Float b) {
  return _mm256_add_ps(a, b);
}
GATELIGHT_INLINE Float sub(Float a, Float b) {
  return _mm256_sub_ps(a, b);
}
GATELIGHT_INLINE Float mul(Float a, Float b) {
  return _mm256_mul_ps(a, b);
}
GATELIGHT_INLINE Float div(Float a, Float b) {
  return _mm256_div_ps(a, b);
}
GATELIGHT_INLINE Float fma(Float a, Float b, Float c) {
  return _mm256_fmadd_ps(a, b, c);
}
GATELIGHT_INLINE Float min(Float a, Float b) {
  return _mm256_min_ps(a, b);
}
GATELIGHT_INLINE Float max(Float a, Float b) {
  return _mm256_max_ps(a, b);
}
GATELIGHT_INLINE Float sqrt(Float a) {
  return _mm256_sqrt_ps(a);
}
GATELIGHT_INLINE Float floor(Float a) {
  return _mm256_floor_ps(a);
}
GATELIGHT_INLINE Float round(Float a) {
  return _mm256_round_ps(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
GATELIGHT_INLINE Float select(Mask m, Float a, Float b) {
  return _mm256_blendv_ps(b, a, _mm256_castsi256_ps(m.m));
}
GATELIGHT_INLINE Mask less(Float a, Float b) {
  return {_mm256_castps_si256(_mm256_cmp_ps(a, b, _CMP_LT_OQ))};
}
GATELIGHT_INLINE Mask equal(Float a, Float b) {
  return {_mm256_castps_si256(_mm256_cmp_ps(a, b, _CMP_EQ_OQ))};
}
GATELIGHT_INLINE Mask both(Mask a, Mask b) {
  return {_mm256_and_si256(a.m, b.m)};
}
GATELIGHT_INLINE Mask either(Mask a, Mask b) {
  return {_mm256_or_si256(a.m, b.m)};
}
GATELIGHT_INLINE uint32_t bits(Mask m) {
  return static_cast<uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(m.m)));
}
GATELIGHT_INLINE Float gather(const float* p, Int i) {
  return _mm256_i32gather_ps(p, i, 4);
}
GATELIGHT_INLINE Float pick4(const float* p, Int i) {
  return _mm256_permutevar_ps(_mm256_broadcast_ps(reinterpret_cast<const __m128*>(p)), i);
}
template <int kLane>
GATELIGHT_INLINE Float repeat4(Float a) {
  return _mm256_permute_ps(a, kLane * 0x55);
}
GATELIGHT_INLINE void store_sum4(float* p, Float a) {
  _mm_storeu_ps(p, _mm_add_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1)));
}
GATELIGHT_INLINE Float load_first4(const float* p) {
  return _mm256_zextps128_ps256(_mm_loadu_ps(p));
}
GATELIGHT_INLINE float sum(Float a) {
  __m128 x = _mm_add_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
  x = _mm_add_ps(x, _mm_movehl_ps(x, x));
  return _mm_cvtss_f32(_mm_add_ss(x, _mm_movehdup_ps(x)));
}

GATELIGHT_INLINE Int load_int(const uint32_t* p) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
}
GATELIGHT_INLINE void store_int(uint32_t* p, Int a) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), a);
}
GATELIGHT_INLINE Int broadcast_int(uint32_t a) {
  return _mm256_set1_epi32(static_cast<int>(a));
}
GATELIGHT_INLINE Int add_int(Int a, Int b) {
  return _mm256_add_epi32(a, b);
}
GATELIGHT_INLINE Int sub_int(Int a, Int b) {
  return _mm256_sub_epi32(a, b);
}
GATELIGHT_INLINE Int mul_int(Int a, Int b) {
  return _mm256_mullo_epi32(a, b);
}
GATELIGHT_INLINE Int xor_int(Int a, Int b) {
  return _mm256_xor_si256(a, b);
}
GATELIGHT_INLINE Int half_int(Int a) {
  return _mm256_srli_epi32(a, 1);
}
GATELIGHT_INLINE Int select_int(Mask m, Int a, Int b) {
  return _mm256_blendv_epi8(b, a, m.m);
}
GATELIGHT_INLINE Mask equal_int(Int a, Int b) {
  return {_mm256_cmpeq_epi32(a, b)};
}
GATELIGHT_INLINE Mask less_unsigned(Int a, Int b) {
  const __m256i top = _mm256_set1_epi32(INT32_MIN);
  return {_mm256_cmpgt_epi32(_mm256_xor_si256(b, top), _mm256_xor_si256(a, top))};
}
GATELIGHT_INLINE Int gather_int(const uint32_t* p, Int i) {
  return _mm256_i32gather_epi32(reinterpret_cast<const int*>(p), i, 4);
}
GATELIGHT_INLINE Int and_int(Int a, Int b) {
  return _mm256_and_si256(a, b);
}
GATELIGHT_INLINE Int shift_right(Int a, uint32_t n) {
  return _mm256_srl_epi32(a, _mm_cvtsi32_si128(static_cast<int>(n)));
}
GATELIGHT_INLINE Int multiply_high(Int a, Int b) {
  const Int even = _mm256_srli_epi64(_mm256_mul_epu32(a, b), 32);
  const Int odd = _mm256_mul_epu32(_mm256_srli_epi64(a, 32), b);
  return _mm256_blend_epi32(even, odd, 0xaa);
}
GATELIGHT_INLINE uint32_t first_lane(Int a) {
  return static_cast<uint32_t>(_mm_cvtsi128_si32(_mm256_castsi256_si128(a)));
}
GATELIGHT_INLINE Int bits_of(Float a) {
  return _mm256_castps_si256(a);
}
GATELIGHT_INLINE Float float_of(Int a) {
  return _mm256_castsi256_ps(a);
}
GATELIGHT_INLINE Int to_int(Float a) {
  return _mm256_cvttps_epi32(a);
}
GATELIGHT_INLINE Float to_float(Int a) {
  return _mm256_cvtepi32_ps(a);
}

template <class Address>
GATELIGHT_INLINE void load_columns4(Address address, Int (&columns)[4]) {
  __m256i rows[4];
#pragma GCC unroll 4
  for (uint32_t j = 0; j < 4; ++j) {
    const __m128i low = _mm_loadu_si128(reinterpret_cast<const __m128i*>(address(j)));
    const __m128i high = _mm_loadu_si128(reinterpret_cast<const __m128i*>(address(j + 4)));
    rows[j] = _mm256_inserti128_si256(_mm256_castsi128_si256(low), high, 1);
  }
  const __m256i low01 = _mm256_unpacklo_epi32(rows[0], rows[1]),
                high01 = _mm256_unpackhi_epi32(rows[0], rows[1]);
  const __m256i low23 = _mm256_unpacklo_epi32(rows[2], rows[3]),
                high23 = _mm256_unpackhi_epi32(rows[2], rows[3]);
  columns[0] = _mm256_unpacklo_epi64(low01, low23);
  columns[1] = _mm256_unpackhi_epi64(low01, low23);
  columns[2] = _mm256_unpacklo_epi64(high01, high23);
  columns[3] = _mm256_unpackhi_epi64(high01, high23);
}
GATELIGHT_INLINE void load_pairs(const float* p, Float& first, Float& second) {
  const __m256 a = _mm256_loadu_ps(p), b = _mm256_loadu_ps(p + 8);
  const __m256i even = _mm256_castps_si256(_mm256_shuffle_ps(a, b, 0x88));
  const __m256i odd = _mm256_castps_si256(_mm256_shuffle_ps(a, b, 0xdd));
  first = _mm256_castsi256_ps(_mm256_permute4x64_epi64(even, 0xd8));
  second = _mm256_castsi256_ps(_mm256_permute4x64_epi64(odd, 0xd8));
}

#else

constexpr uint32_t kLanes = 1;
constexpr uint32_t kBlockRows = 6;
constexpr uint32_t kBlockVectors = 2;
using Float = float;
using Int = uint32_t;
using Mask = bool;

GATELIGHT_INLINE Float load(const float* p) {
  return *p;
}
GATELIGHT_INLINE void store(float* p, Float a) {
  *p = a;
}
GATELIGHT_INLINE Float load_partial(const float* p, uint32_t) {
  return *p;
}
GATELIGHT_INLINE void store_partial(float* p, Float a, uint32_t) {
  *p = a;
}
GATELIGHT_INLINE Float broadcast(float a) {
  return a;
}
GATELIGHT_INLINE Float zero() {
  return 0.0f;
}
GATELIGHT_INLINE Float add(Float a, Float b) {
  return a + b;
}
GATELIGHT_INLINE Float sub(Float a, Float b) {
  return a - b;
}
GATELIGHT_INLINE Float mul(Float a, Float b) {
  return a * b;
}
GATELIGHT_INLINE Float div(Float a, Float b) {
  return a / b;
}
GATELIGHT_INLINE Float fma(Float a, Float b, Float c) {
  return a * b + c;
}
// If an operand is NaN, the result is the second one, as with the instructions.
GATELIGHT_INLINE Float min(Float a, Float b) {
  return a < b ? a : b;
}
GATELIGHT_INLINE Float max(Float a, Float b) {
  return a > b ? a : b;
}
GATELIGHT_INLINE Float sqrt(Float a) {
  return __builtin_sqrtf(a);
}
GATELIGHT_INLINE Float floor(Float a) {
  return __builtin_floorf(a);
}
GATELIGHT_INLINE Float round(Float a) {
  return __builtin_rintf(a);
}
GATELIGHT_INLINE Float select(Mask m, Float a, Float b) {
  return m ? a : b;
}
GATELIGHT_INLINE Mask less(Float a, Float b) {
  return a < b;
}
GATELIGHT_INLINE Mask equal(Float a, Float b) {
  return a == b;
}
GATELIGHT_INLINE Mask both(Mask a, Mask b) {
  return a && b;
}
GATELIGHT_INLINE Mask either(Mask a, Mask b) {
  return a || b;
}
GATELIGHT_INLINE uint32_t bits(Mask m) {
  return m ? 1u : 0u;
}
GATELIGHT_INLINE Float gather(const float* p, Int i) {
  return p[i];
}
GATELIGHT_INLINE Float pick4(const float* p, Int i) {
  return p[i];
}
GATELIGHT_INLINE float sum(Float a) {
  return a;
}

GATELIGHT_INLINE Int load_int(const uint32_t* p) {
  return *p;
}
GATELIGHT_INLINE void store_int(uint32_t* p, Int a) {
  *p = a;
}
GATELIGHT_INLINE Int broadcast_int(uint32_t a) {
  return a;
}
GATELIGHT_INLINE Int lane_numbers() {
  return 0;
}
GATELIGHT_INLINE Int add_int(Int a, Int b) {
  return a + b;
}
GATELIGHT_INLINE Int sub_int(Int a, Int b) {
  return a - b;
}
GATELIGHT_INLINE Int mul_int(Int a, Int b) {
  return a * b;
}
GATELIGHT_INLINE Int xor_int(Int a, Int b) {
  return a ^ b;
}
GATELIGHT_INLINE Int half_int(Int a) {
  return a >> 1;
}
GATELIGHT_INLINE Int select_int(Mask m, Int a, Int b) {
  return m ? a : b;
}
GATELIGHT_INLINE Mask equal_int(Int a, Int b) {
  return a == b;
}
GATELIGHT_INLINE Mask less_unsigned(Int a, Int b) {
  return a < b;
}
GATELIGHT_INLINE Int gather_int(const uint32_t* p, Int i) {
  return p[i];
}
GATELIGHT_INLINE Int and_int(Int a, Int b) {
  return a & b;
}
GATELIGHT_INLINE Int shift_right(Int a, uint32_t n) {
  return a >> n;
}
GATELIGHT_INLINE Int multiply_high(Int a, Int b) {
  return static_cast<Int>(uint64_t{a} * b >> 32);
}
GATELIGHT_INLINE uint32_t first_lane(Int a) {
  return a;
}
GATELIGHT_INLINE Int bits_of(Float a) {
  Int word;
  __builtin_memcpy(&word, &a, 4);
  return word;
}
GATELIGHT_INLINE Float float_of(Int a) {
  Float value;
  __builtin_memcpy(&value, &a, 4);
  return value;
}
GATELIGHT_INLINE Int to_int(Float a) {
  return static_cast<Int>(static_cast<int32_t>(a));
}
GATELIGHT_INLINE Float to_float(Int a) {
  return static_cast<Float>(static_cast<int32_t>(a));
}

template <class Address>
GATELIGHT_INLINE void load_columns4(Address address, Int (&columns)[4]) {
  __builtin_memcpy(columns, address(0), sizeof columns);
}
GATELIGHT_INLINE void load_pairs(const float* p, Float& first, Float& second) {
  first = p[0];
  second = p[1];
}

#endif

/// A number as a type, for lambdas that need a compile-time constant.
template <uint32_t kValue>
struct Constant {
  static constexpr uint32_t value = kValue;
};

constexpr uint32_t kAllLanes = kLanes == 32 ? ~0u : (1u << kLanes) - 1u;

GATELIGHT_INLINE bool all(Mask m) {
  return bits(m) == kAllLanes;
}
GATELIGHT_INLINE bool any(Mask m) {
  return bits(m) != 0;
}
GATELIGHT_INLINE Float absolute(Float a) {
  return max(a, sub(zero(), a));
}
GATELIGHT_INLINE Float clamp(Float a, float low, float high) {
  return min(max(a, broadcast(low)), broadcast(high));
}
GATELIGHT_INLINE Mask finite(Float a) {
  return equal(sub(a, a), zero());
}

/// Rounds a finite value to the eight significant bits of bf16, ties to even.
GATELIGHT_INLINE Float round_to_bf16(Float a) {
  const Int word = bits_of(a);
  const Int odd = and_int(shift_right(word, 16), broadcast_int(1));
  return float_of(and_int(add_int(word, add_int(odd, broadcast_int(0x7fffu))), broadcast_int(0xffff0000u)));
}

/// Prefetches into the L1 cache, for data that is read soon.
GATELIGHT_INLINE void prefetch(const void* p) {
  __builtin_prefetch(p, 0, 3);
}
/// Prefetches into the L2 cache, for data that is read after a tile's arithmetic.
GATELIGHT_INLINE void prefetch_far(const void* p) {
  __builtin_prefetch(p, 0, 2);
}

}  // namespace

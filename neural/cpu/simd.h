#pragma once
// The vectors of the kernels: the same names for scalar code, AVX2 and AVX-512. Only kernel_table.cpp
// includes this file; it is compiled once for each instruction set with GATELIGHT_ISA_SCALAR, _AVX2 or
// _AVX512 defined. Everything is internal to that object file, so the linker cannot mix the symbols of
// instruction sets.
//
// Float and Int are vectors of the compiler (numbers in scalar code), so + - * / & ^ >> work on them, also
// with a number as one operand.

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
#define GATELIGHT_SIMD(name) _mm512_##name
using Register = __m512i;
using Float = __m512;
typedef uint32_t Int __attribute__((vector_size(64)));
using Mask = __mmask16;

GATELIGHT_INLINE Mask first(uint32_t count) {
  return static_cast<Mask>(count >= 16 ? 0xffffu : (1u << count) - 1u);
}
GATELIGHT_INLINE Float load_partial(const float* p, uint32_t count) {
  return _mm512_maskz_loadu_ps(first(count), p);
}
GATELIGHT_INLINE void store_partial(float* p, Float a, uint32_t count) {
  _mm512_mask_storeu_ps(p, first(count), a);
}
GATELIGHT_INLINE Float round(Float a) {
  return _mm512_roundscale_ps(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
GATELIGHT_INLINE Float select(Mask m, Float a, Float b) {
  return _mm512_mask_blend_ps(m, b, a);
}
GATELIGHT_INLINE Int select(Mask m, Int a, Int b) {
  return (Int)_mm512_mask_blend_epi32(m, (Register)b, (Register)a);
}
GATELIGHT_INLINE Mask less(Float a, Float b) {
  return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ);
}
GATELIGHT_INLINE Mask less(Int a, Int b) {
  return _mm512_cmplt_epu32_mask((Register)a, (Register)b);
}
GATELIGHT_INLINE Mask equal(Float a, Float b) {
  return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ);
}
GATELIGHT_INLINE Mask equal(Int a, Int b) {
  return _mm512_cmpeq_epi32_mask((Register)a, (Register)b);
}
GATELIGHT_INLINE uint32_t bits(Mask m) {
  return m;
}
GATELIGHT_INLINE Int gather(const uint32_t* p, Int i) {
  return (Int)_mm512_i32gather_epi32((Register)i, p, 4);
}
GATELIGHT_INLINE Float repeat_four(const float* p) {
  return _mm512_broadcast_f32x4(_mm_loadu_ps(p));
}
GATELIGHT_INLINE float sum(Float a) {
  return _mm512_reduce_add_ps(a);
}
/// Stores the sum of the groups of four lanes.
GATELIGHT_INLINE void store_sum4(float* p, Float a) {
  const __m256 half = _mm256_add_ps(_mm512_castps512_ps256(a), _mm512_extractf32x8_ps(a, 1));
  _mm_storeu_ps(p, _mm_add_ps(_mm256_castps256_ps128(half), _mm256_extractf128_ps(half, 1)));
}
GATELIGHT_INLINE Float load_first4(const float* p) {
  return _mm512_zextps128_ps512(_mm_loadu_ps(p));
}
GATELIGHT_INLINE Register odd_words(Register odd, Register even) {
  return _mm512_mask_blend_epi32(0xaaaa, even, odd);
}
/// Loads four words from each of the addresses of lanes j, j + 4, j + 8 ...
template <class Address>
GATELIGHT_INLINE Register load_rows4(Address address, uint32_t j) {
  const auto part = [&](uint32_t l) __attribute__((always_inline)) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(address(l)));
  };
  Register r = _mm512_castsi128_si512(part(j));
  r = _mm512_inserti32x4(r, part(j + 4), 1);
  r = _mm512_inserti32x4(r, part(j + 8), 2);
  return _mm512_inserti32x4(r, part(j + 12), 3);
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
#define GATELIGHT_SIMD(name) _mm256_##name
using Register = __m256i;
using Float = __m256;
typedef uint32_t Int __attribute__((vector_size(32)));
typedef int32_t Mask __attribute__((vector_size(32)));

GATELIGHT_INLINE Register first(uint32_t count) {
  return _mm256_cmpgt_epi32(_mm256_set1_epi32(static_cast<int>(count)),
                            _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
}
GATELIGHT_INLINE Float load_partial(const float* p, uint32_t count) {
  return _mm256_maskload_ps(p, first(count));
}
GATELIGHT_INLINE void store_partial(float* p, Float a, uint32_t count) {
  _mm256_maskstore_ps(p, first(count), a);
}
GATELIGHT_INLINE Float round(Float a) {
  return _mm256_round_ps(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
GATELIGHT_INLINE Float select(Mask m, Float a, Float b) {
  return _mm256_blendv_ps(b, a, (Float)m);
}
GATELIGHT_INLINE Int select(Mask m, Int a, Int b) {
  return (Int)_mm256_blendv_epi8((Register)b, (Register)a, (Register)m);
}
GATELIGHT_INLINE Mask less(Float a, Float b) {
  return (Mask)_mm256_cmp_ps(a, b, _CMP_LT_OQ);
}
GATELIGHT_INLINE Mask less(Int a, Int b) {
  return (Mask)(a ^ 0x80000000u) < (Mask)(b ^ 0x80000000u);
}
GATELIGHT_INLINE Mask equal(Float a, Float b) {
  return (Mask)_mm256_cmp_ps(a, b, _CMP_EQ_OQ);
}
GATELIGHT_INLINE Mask equal(Int a, Int b) {
  return a == b;
}
GATELIGHT_INLINE uint32_t bits(Mask m) {
  return static_cast<uint32_t>(_mm256_movemask_ps((Float)m));
}
GATELIGHT_INLINE Int gather(const uint32_t* p, Int i) {
  return (Int)_mm256_i32gather_epi32(reinterpret_cast<const int*>(p), (Register)i, 4);
}
GATELIGHT_INLINE Float repeat_four(const float* p) {
  return _mm256_broadcast_ps(reinterpret_cast<const __m128*>(p));
}
GATELIGHT_INLINE float sum(Float a) {
  __m128 x = _mm_add_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
  x = _mm_add_ps(x, _mm_movehl_ps(x, x));
  return _mm_cvtss_f32(_mm_add_ss(x, _mm_movehdup_ps(x)));
}
GATELIGHT_INLINE void store_sum4(float* p, Float a) {
  _mm_storeu_ps(p, _mm_add_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1)));
}
GATELIGHT_INLINE Float load_first4(const float* p) {
  return _mm256_zextps128_ps256(_mm_loadu_ps(p));
}
GATELIGHT_INLINE Register odd_words(Register odd, Register even) {
  return _mm256_blend_epi32(even, odd, 0xaa);
}
template <class Address>
GATELIGHT_INLINE Register load_rows4(Address address, uint32_t j) {
  const __m128i low = _mm_loadu_si128(reinterpret_cast<const __m128i*>(address(j)));
  const __m128i high = _mm_loadu_si128(reinterpret_cast<const __m128i*>(address(j + 4)));
  return _mm256_inserti128_si256(_mm256_castsi128_si256(low), high, 1);
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

GATELIGHT_INLINE Float load_partial(const float* p, uint32_t) {
  return *p;
}
GATELIGHT_INLINE void store_partial(float* p, Float a, uint32_t) {
  *p = a;
}
GATELIGHT_INLINE Float broadcast(float a) {
  return a;
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
template <class V>
GATELIGHT_INLINE V select(Mask m, V a, V b) {
  return m ? a : b;
}
template <class V>
GATELIGHT_INLINE Mask less(V a, V b) {
  return a < b;
}
template <class V>
GATELIGHT_INLINE Mask equal(V a, V b) {
  return a == b;
}
GATELIGHT_INLINE uint32_t bits(Mask m) {
  return m ? 1u : 0u;
}
GATELIGHT_INLINE Int gather(const uint32_t* p, Int i) {
  return p[i];
}
GATELIGHT_INLINE Float pick4(const float* p, Int i) {
  return p[i];
}
GATELIGHT_INLINE float sum(Float a) {
  return a;
}
GATELIGHT_INLINE Int lane_numbers() {
  return 0;
}
GATELIGHT_INLINE Int multiply_high(Int a, Int b) {
  return static_cast<Int>(uint64_t{a} * b >> 32);
}
GATELIGHT_INLINE uint32_t first_lane(Int a) {
  return a;
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

#if !defined(GATELIGHT_ISA_SCALAR)

GATELIGHT_INLINE Float broadcast(float a) {
  return GATELIGHT_SIMD(set1_ps)(a);
}
GATELIGHT_INLINE Float fma(Float a, Float b, Float c) {
  return GATELIGHT_SIMD(fmadd_ps)(a, b, c);
}
GATELIGHT_INLINE Float min(Float a, Float b) {
  return GATELIGHT_SIMD(min_ps)(a, b);
}
GATELIGHT_INLINE Float max(Float a, Float b) {
  return GATELIGHT_SIMD(max_ps)(a, b);
}
GATELIGHT_INLINE Float sqrt(Float a) {
  return GATELIGHT_SIMD(sqrt_ps)(a);
}
GATELIGHT_INLINE Float floor(Float a) {
  return GATELIGHT_SIMD(floor_ps)(a);
}
/// Lane l takes p[i[l]], i in 0..3.
GATELIGHT_INLINE Float pick4(const float* p, Int i) {
  return GATELIGHT_SIMD(permutevar_ps)(repeat_four(p), (Register)i);
}
/// Copies lane kLane of each group of four lanes to the whole group.
template <int kLane>
GATELIGHT_INLINE Float repeat4(Float a) {
  return GATELIGHT_SIMD(permute_ps)(a, kLane * 0x55);
}
GATELIGHT_INLINE Int lane_numbers() {
  Int lanes;
  for (uint32_t l = 0; l < kLanes; ++l) lanes[l] = l;
  return lanes;
}
/// The upper half of the product of 32-bit numbers.
GATELIGHT_INLINE Int multiply_high(Int a, Int b) {
  const Register even = GATELIGHT_SIMD(srli_epi64)(GATELIGHT_SIMD(mul_epu32)((Register)a, (Register)b), 32);
  const Register odd = GATELIGHT_SIMD(mul_epu32)(GATELIGHT_SIMD(srli_epi64)((Register)a, 32), (Register)b);
  return (Int)odd_words(odd, even);
}
GATELIGHT_INLINE uint32_t first_lane(Int a) {
  return a[0];
}
GATELIGHT_INLINE Int to_int(Float a) {
  return (Int)GATELIGHT_SIMD(cvttps_epi32)(a);
}
GATELIGHT_INLINE Float to_float(Int a) {
  return GATELIGHT_SIMD(cvtepi32_ps)((Register)a);
}
/// Loads four words from each of kLanes addresses: lane l of column c is address(l)[c].
template <class Address>
GATELIGHT_INLINE void load_columns4(Address address, Int (&columns)[4]) {
  Register rows[4], pairs[4];
#pragma GCC unroll 4
  for (uint32_t j = 0; j < 4; ++j) rows[j] = load_rows4(address, j);
#pragma GCC unroll 2
  for (uint32_t j = 0; j < 4; j += 2) {
    pairs[j] = GATELIGHT_SIMD(unpacklo_epi32)(rows[j], rows[j + 1]);
    pairs[j + 1] = GATELIGHT_SIMD(unpackhi_epi32)(rows[j], rows[j + 1]);
  }
#pragma GCC unroll 2
  for (uint32_t j = 0; j < 2; ++j) {
    columns[2 * j] = (Int)GATELIGHT_SIMD(unpacklo_epi64)(pairs[j], pairs[j + 2]);
    columns[2 * j + 1] = (Int)GATELIGHT_SIMD(unpackhi_epi64)(pairs[j], pairs[j + 2]);
  }
}

#endif

/// A number as a type, for lambdas that need a compile-time constant.
template <uint32_t kValue>
struct Constant {
  static constexpr uint32_t value = kValue;
};

constexpr uint32_t kAllLanes = (1u << kLanes) - 1u;

// Vectors in memory, which is aligned to their elements only.
typedef Float FloatAt __attribute__((aligned(4), may_alias));
typedef Int IntAt __attribute__((aligned(4), may_alias));

GATELIGHT_INLINE Float load(const float* p) {
  return *reinterpret_cast<const FloatAt*>(p);
}
GATELIGHT_INLINE Int load(const uint32_t* p) {
  return *reinterpret_cast<const IntAt*>(p);
}
GATELIGHT_INLINE void store(float* p, Float a) {
  *reinterpret_cast<FloatAt*>(p) = a;
}
GATELIGHT_INLINE void store(uint32_t* p, Int a) {
  *reinterpret_cast<IntAt*>(p) = a;
}
GATELIGHT_INLINE Float zero() {
  return Float{};
}
GATELIGHT_INLINE Int broadcast_int(uint32_t a) {
  return Int{} + a;
}
GATELIGHT_INLINE Int bits_of(Float a) {
  return __builtin_bit_cast(Int, a);
}
GATELIGHT_INLINE Float float_of(Int a) {
  return __builtin_bit_cast(Float, a);
}
GATELIGHT_INLINE Mask both(Mask a, Mask b) {
  return static_cast<Mask>(a & b);
}
GATELIGHT_INLINE Mask either(Mask a, Mask b) {
  return static_cast<Mask>(a | b);
}
GATELIGHT_INLINE bool all(Mask m) {
  return bits(m) == kAllLanes;
}
GATELIGHT_INLINE bool any(Mask m) {
  return bits(m) != 0;
}
GATELIGHT_INLINE Float absolute(Float a) {
  return max(a, zero() - a);
}
GATELIGHT_INLINE Float clamp(Float a, float low, float high) {
  return min(max(a, broadcast(low)), broadcast(high));
}

/// Rounds a finite value to the eight significant bits of bf16, ties to even.
GATELIGHT_INLINE Float round_to_bf16(Float a) {
  const Int word = bits_of(a);
  const Int odd = word >> 16 & 1u;
  return float_of((word + (odd + 0x7fffu)) & 0xffff0000u);
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

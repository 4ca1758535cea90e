#pragma once
// Vectors of the widest registers that an object is compiled for: 16 lanes for AVX-512, 8 for AVX2, 4 for all
// others, where the compiler's own vectors serve SSE2 and NEON alike. Only kernel sources include this file.
// They are compiled once for each instruction set (cmake/Kernels.cmake), and everything here is internal to
// their object, so the linker cannot mix the code of instruction sets.
//
// Each operation rounds as IEEE 754 says. So a kernel that is compiled without contraction gives the same
// bits on every instruction set.

#include <stdint.h>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#define GATELIGHT_INLINE inline __attribute__((always_inline))
// For loops that need all registers. If they are inlined, gcc keeps the caller's constants in registers
// across them and spills an operand in each step (a third slower).
#define GATELIGHT_NOINLINE static __attribute__((noinline))

namespace {

#if defined(__AVX512F__)
constexpr int kLanes = 16;
#define GATELIGHT_SIMD(name) _mm512_##name
using FloatRegister = __m512;
using IntRegister = __m512i;
#elif defined(__AVX2__)
constexpr int kLanes = 8;
#define GATELIGHT_SIMD(name) _mm256_##name
using FloatRegister = __m256;
using IntRegister = __m256i;
#else
constexpr int kLanes = 4;
#if defined(__SSE2__)
#define GATELIGHT_SIMD(name) _mm_##name
#endif
typedef float FloatRegister __attribute__((vector_size(16)));
typedef long long IntRegister __attribute__((vector_size(16)));
#endif
typedef uint32_t Words __attribute__((vector_size(4 * kLanes)));
typedef int32_t SignedWords __attribute__((vector_size(4 * kLanes)));
typedef uint64_t Pairs __attribute__((vector_size(4 * kLanes)));

/// One truth value for each lane: a mask register, or all bits of a lane.
struct Mask {
#if defined(__AVX512F__)
  using Register = __mmask16;
#else
  using Register = SignedWords;
#endif
  Register m;

  friend GATELIGHT_INLINE Mask operator&(Mask a, Mask b) {
    return {static_cast<Register>(a.m & b.m)};
  }
  friend GATELIGHT_INLINE Mask operator|(Mask a, Mask b) {
    return {static_cast<Register>(a.m | b.m)};
  }
  friend GATELIGHT_INLINE Mask operator~(Mask a) {
    return {static_cast<Register>(~a.m)};
  }
  GATELIGHT_INLINE Mask& operator&=(Mask b) {
    return *this = *this & b;
  }
  GATELIGHT_INLINE Mask& operator|=(Mask b) {
    return *this = *this | b;
  }
};

GATELIGHT_INLINE Mask no_lanes() {
  return {Mask::Register{}};
}
/// One bit for each lane.
GATELIGHT_INLINE uint32_t lane_bits(Mask a) {
#if defined(__AVX512F__)
  return a.m;
#elif defined(GATELIGHT_SIMD)
  return static_cast<uint32_t>(GATELIGHT_SIMD(movemask_ps)((FloatRegister)a.m));
#else
  return (a.m[0] & 1u) | (a.m[1] & 2u) | (a.m[2] & 4u) | (a.m[3] & 8u);
#endif
}
GATELIGHT_INLINE bool any(Mask a) {
  return lane_bits(a) != 0;
}
GATELIGHT_INLINE bool all(Mask a) {
  return lane_bits(a) == (1u << kLanes) - 1u;
}

/// Lanes of 32-bit numbers without a sign.
struct Int {
  Words v;

  Int() = default;
  GATELIGHT_INLINE Int(Words x) : v(x) {}
  GATELIGHT_INLINE Int(IntRegister x) : v((Words)x) {}
  GATELIGHT_INLINE Int(uint32_t x) : v(Words{} + x) {}

  friend GATELIGHT_INLINE Int operator+(Int a, Int b) { return a.v + b.v; }
  friend GATELIGHT_INLINE Int operator-(Int a, Int b) { return a.v - b.v; }
  friend GATELIGHT_INLINE Int operator*(Int a, Int b) { return a.v * b.v; }
  friend GATELIGHT_INLINE Int operator&(Int a, Int b) { return a.v & b.v; }
  friend GATELIGHT_INLINE Int operator|(Int a, Int b) { return a.v | b.v; }
  friend GATELIGHT_INLINE Int operator^(Int a, Int b) { return a.v ^ b.v; }
  friend GATELIGHT_INLINE Int operator>>(Int a, int bits) { return a.v >> bits; }
  friend GATELIGHT_INLINE Int operator<<(Int a, int bits) { return a.v << bits; }
  GATELIGHT_INLINE Int& operator^=(Int b) { return *this = *this ^ b; }
  GATELIGHT_INLINE Int& operator+=(Int b) { return *this = *this + b; }
  GATELIGHT_INLINE Int& operator*=(Int b) { return *this = *this * b; }
};

struct Float {
  FloatRegister v;

  Float() = default;
  GATELIGHT_INLINE Float(FloatRegister x) : v(x) {}
  GATELIGHT_INLINE Float(float x) : v(x - FloatRegister{}) {}  // exact for -0, too: costs no instruction

  friend GATELIGHT_INLINE Float operator+(Float a, Float b) { return a.v + b.v; }
  friend GATELIGHT_INLINE Float operator-(Float a, Float b) { return a.v - b.v; }
  friend GATELIGHT_INLINE Float operator*(Float a, Float b) { return a.v * b.v; }
  friend GATELIGHT_INLINE Float operator/(Float a, Float b) { return a.v / b.v; }
  friend GATELIGHT_INLINE Float operator-(Float a) { return -a.v; }
  GATELIGHT_INLINE Float& operator+=(Float b) { return *this = *this + b; }
  GATELIGHT_INLINE Float& operator-=(Float b) { return *this = *this - b; }
  GATELIGHT_INLINE Float& operator*=(Float b) { return *this = *this * b; }
};

GATELIGHT_INLINE Int bits_of(Float a) {
  return (Words)a.v;
}
GATELIGHT_INLINE Float float_of(Int a) {
  return (FloatRegister)a.v;
}

#if defined(__AVX512F__)

GATELIGHT_INLINE Mask operator<(Float a, Float b) {
  return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ)};
}
GATELIGHT_INLINE Mask operator<=(Float a, Float b) {
  return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ)};
}
GATELIGHT_INLINE Mask operator==(Float a, Float b) {
  return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_EQ_OQ)};
}
GATELIGHT_INLINE Mask operator<(Int a, Int b) {
  return {_mm512_cmplt_epu32_mask((IntRegister)a.v, (IntRegister)b.v)};
}
GATELIGHT_INLINE Mask operator==(Int a, Int b) {
  return {_mm512_cmpeq_epi32_mask((IntRegister)a.v, (IntRegister)b.v)};
}
GATELIGHT_INLINE Float select(Mask m, Float a, Float b) {
  return _mm512_mask_blend_ps(m.m, b.v, a.v);
}
GATELIGHT_INLINE Int select(Mask m, Int a, Int b) {
  return _mm512_mask_blend_epi32(m.m, (IntRegister)b.v, (IntRegister)a.v);
}
GATELIGHT_INLINE Float select_or_zero(Mask m, Float a) {
  return _mm512_maskz_mov_ps(m.m, a.v);
}
GATELIGHT_INLINE Int select_or_zero(Mask m, Int a) {
  return _mm512_maskz_mov_epi32(m.m, (IntRegister)a.v);
}
/// All bits of a lane, where the mask is set.
GATELIGHT_INLINE Int words_of(Mask m) {
  return _mm512_movm_epi32(m.m);
}
GATELIGHT_INLINE Mask mask_of(Int words) {
  return {_mm512_movepi32_mask((IntRegister)words.v)};
}

#else

GATELIGHT_INLINE Mask operator<(Float a, Float b) {
  return {a.v < b.v};
}
GATELIGHT_INLINE Mask operator<=(Float a, Float b) {
  return {a.v <= b.v};
}
GATELIGHT_INLINE Mask operator==(Float a, Float b) {
  return {a.v == b.v};
}
GATELIGHT_INLINE Mask operator<(Int a, Int b) {
  return {a.v < b.v};
}
GATELIGHT_INLINE Mask operator==(Int a, Int b) {
  return {a.v == b.v};
}
GATELIGHT_INLINE Float select(Mask m, Float a, Float b) {
#if defined(__AVX2__)
  return _mm256_blendv_ps(b.v, a.v, (FloatRegister)m.m);
#else
  return (FloatRegister)(((SignedWords)a.v & m.m) | ((SignedWords)b.v & ~m.m));
#endif
}
GATELIGHT_INLINE Int select(Mask m, Int a, Int b) {
  return bits_of(select(m, float_of(a), float_of(b)));
}
GATELIGHT_INLINE Float select_or_zero(Mask m, Float a) {
  return (FloatRegister)((SignedWords)a.v & m.m);
}
GATELIGHT_INLINE Int select_or_zero(Mask m, Int a) {
  return a.v & (Words)m.m;
}
GATELIGHT_INLINE Int words_of(Mask m) {
  return (Words)m.m;
}
GATELIGHT_INLINE Mask mask_of(Int words) {
  return {(SignedWords)words.v};
}

#endif

GATELIGHT_INLINE Mask operator>(Float a, Float b) {
  return b < a;
}
GATELIGHT_INLINE Mask operator>=(Float a, Float b) {
  return b <= a;
}
// If an operand is NaN, the result is the second one, as with the instructions.
GATELIGHT_INLINE Float min(Float a, Float b) {
#if defined(GATELIGHT_SIMD)
  return GATELIGHT_SIMD(min_ps)(a.v, b.v);
#else
  return select(a < b, a, b);
#endif
}
GATELIGHT_INLINE Float max(Float a, Float b) {
#if defined(GATELIGHT_SIMD)
  return GATELIGHT_SIMD(max_ps)(a.v, b.v);
#else
  return select(a > b, a, b);
#endif
}
GATELIGHT_INLINE Float sqrt(Float a) {
#if defined(GATELIGHT_SIMD)
  return GATELIGHT_SIMD(sqrt_ps)(a.v);
#else
  for (int l = 0; l < kLanes; ++l) a.v[l] = __builtin_sqrtf(a.v[l]);
  return a;
#endif
}
GATELIGHT_INLINE Float absolute(Float a) {
  return float_of(bits_of(a) & 0x7fffffffu);
}
/// The magnitude 1 with the sign of `a`, that of -0 too.
GATELIGHT_INLINE Float sign_of(Float a) {
  return float_of((bits_of(a) & 0x80000000u) | bits_of(1.0f));
}
GATELIGHT_INLINE Float clamp(Float a, Float low, Float high) {
  return min(max(a, low), high);
}
/// To the nearest whole number, ties to even.
GATELIGHT_INLINE Float round(Float a) {
#if defined(__AVX512F__)
  return _mm512_roundscale_ps(a.v, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
#elif defined(__AVX2__)
  return _mm256_round_ps(a.v, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
#else
  // From 2^23 on, all numbers are whole.
  const Float magnitude = absolute(a);
  const Float whole = select(magnitude < 0x1p23f, (magnitude + 0x1p23f) - 0x1p23f, magnitude);
  return float_of(bits_of(whole) | (bits_of(a) & 0x80000000u));
#endif
}
GATELIGHT_INLINE Float floor(Float a) {
#if defined(__AVX2__)
  return GATELIGHT_SIMD(floor_ps)(a.v);
#else
  const Float nearest = round(a);
  return nearest - select_or_zero(nearest > a, Float(1.0f));
#endif
}
/// Towards zero. The magnitude is below 2^31.
GATELIGHT_INLINE Int to_int(Float a) {
  return (Words) __builtin_convertvector(a.v, SignedWords);
}
/// The number counts as signed.
GATELIGHT_INLINE Float to_float(Int a) {
  return __builtin_convertvector((SignedWords)a.v, FloatRegister);
}
/// The upper half of the product.
GATELIGHT_INLINE Int multiply_high(Int a, uint32_t b) {
#if defined(GATELIGHT_SIMD)
  const auto multiply = [&](Pairs x) __attribute__((always_inline)) {
    return (Pairs)GATELIGHT_SIMD(mul_epu32)((IntRegister)x, (IntRegister)Int(b).v);
  };
#else
  const auto multiply = [&](Pairs x) __attribute__((always_inline)) {
    return (x & 0xffffffffu) * b;
  };
#endif
  const Pairs even = multiply((Pairs)a.v) >> 32, odd = multiply((Pairs)a.v >> 32);
#if defined(__AVX512F__)
  return _mm512_mask_blend_epi32(0xaaaa, (IntRegister)even, (IntRegister)odd);
#elif defined(__AVX2__)
  return _mm256_blend_epi32((IntRegister)even, (IntRegister)odd, 0xaa);
#else
  return (Words)(even | (odd & ~uint64_t{0xffffffffu}));
#endif
}
GATELIGHT_INLINE Int lane_numbers() {
  Words lanes;
  for (int l = 0; l < kLanes; ++l) lanes[l] = static_cast<uint32_t>(l);
  return lanes;
}

// Vectors in memory, which is aligned to their elements only.
typedef FloatRegister FloatsAt __attribute__((aligned(4), may_alias));
typedef Words WordsAt __attribute__((aligned(4), may_alias));

GATELIGHT_INLINE Float load(const float* p) {
  return *reinterpret_cast<const FloatsAt*>(p);
}
GATELIGHT_INLINE Int load(const uint32_t* p) {
  return *reinterpret_cast<const WordsAt*>(p);
}
GATELIGHT_INLINE void store(float* p, Float a) {
  *reinterpret_cast<FloatsAt*>(p) = a.v;
}
GATELIGHT_INLINE void store(uint32_t* p, Int a) {
  *reinterpret_cast<WordsAt*>(p) = a.v;
}
#if defined(__AVX512F__)
GATELIGHT_INLINE Mask::Register first_lanes(uint32_t count) {
  return static_cast<Mask::Register>(count >= 16 ? 0xffffu : (1u << count) - 1u);
}
#elif defined(__AVX2__)
GATELIGHT_INLINE IntRegister first_lanes(uint32_t count) {
  return _mm256_cmpgt_epi32(_mm256_set1_epi32(static_cast<int>(count)), (IntRegister)lane_numbers().v);
}
#endif
/// The first `count` numbers at p, and zeros. No other numbers are read.
GATELIGHT_INLINE Float load_partial(const float* p, uint32_t count) {
#if defined(__AVX512F__)
  return _mm512_maskz_loadu_ps(first_lanes(count), p);
#elif defined(__AVX2__)
  return _mm256_maskload_ps(p, first_lanes(count));
#else
  FloatRegister result = {};
  for (uint32_t l = 0; l < kLanes && l < count; ++l) result[l] = p[l];
  return result;
#endif
}
/// Stores the first `count` lanes.
GATELIGHT_INLINE void store_partial(float* p, Float a, uint32_t count) {
#if defined(__AVX512F__)
  _mm512_mask_storeu_ps(p, first_lanes(count), a.v);
#elif defined(__AVX2__)
  _mm256_maskstore_ps(p, first_lanes(count), a.v);
#else
  for (uint32_t l = 0; l < kLanes && l < count; ++l) p[l] = a.v[l];
#endif
}
/// Separates consecutive pairs: first[l] = p[2 l], second[l] = p[2 l + 1].
GATELIGHT_INLINE void load_pairs(const float* p, Float& first, Float& second) {
  const FloatRegister a = load(p).v, b = load(p + kLanes).v;
#if defined(__AVX512F__)
  const Int even = lane_numbers() * 2u;
  first = _mm512_permutex2var_ps(a, (IntRegister)even.v, b);
  second = _mm512_permutex2var_ps(a, (IntRegister)(even + 1u).v, b);
#elif defined(__AVX2__)
  const __m256i even = _mm256_castps_si256(_mm256_shuffle_ps(a, b, 0x88));
  const __m256i odd = _mm256_castps_si256(_mm256_shuffle_ps(a, b, 0xdd));
  first = _mm256_castsi256_ps(_mm256_permute4x64_epi64(even, 0xd8));
  second = _mm256_castsi256_ps(_mm256_permute4x64_epi64(odd, 0xd8));
#else
  first = __builtin_shufflevector(a, b, 0, 2, 4, 6);
  second = __builtin_shufflevector(a, b, 1, 3, 5, 7);
#endif
}
/// Lane l is p[i[l]]; i is below 2^31.
GATELIGHT_INLINE Int gather(const uint32_t* p, Int i) {
#if defined(__AVX512F__)
  return _mm512_i32gather_epi32((IntRegister)i.v, p, 4);
#elif defined(__AVX2__)
  return _mm256_i32gather_epi32(reinterpret_cast<const int*>(p), (IntRegister)i.v, 4);
#else
  Words result;
  for (int l = 0; l < kLanes; ++l) result[l] = p[i.v[l]];
  return result;
#endif
}
GATELIGHT_INLINE Float gather(const float* p, Int i) {
#if defined(__AVX512F__)
  return _mm512_i32gather_ps((IntRegister)i.v, p, 4);
#elif defined(__AVX2__)
  return _mm256_i32gather_ps(p, (IntRegister)i.v, 4);
#else
  FloatRegister result;
  for (int l = 0; l < kLanes; ++l) result[l] = p[i.v[l]];
  return result;
#endif
}

}  // namespace

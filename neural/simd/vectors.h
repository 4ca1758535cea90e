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
GATELIGHT_INLINE bool any(Mask a) {
#if defined(__AVX512F__)
  return a.m != 0;
#elif defined(__AVX2__)
  return _mm256_movemask_ps((FloatRegister)a.m) != 0;
#else
  const Pairs p = (Pairs)a.m;
  return (p[0] | p[1]) != 0;
#endif
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
  GATELIGHT_INLINE Float(float x) : v(FloatRegister{} + x) {}

  friend GATELIGHT_INLINE Float operator+(Float a, Float b) { return a.v + b.v; }
  friend GATELIGHT_INLINE Float operator-(Float a, Float b) { return a.v - b.v; }
  friend GATELIGHT_INLINE Float operator*(Float a, Float b) { return a.v * b.v; }
  friend GATELIGHT_INLINE Float operator/(Float a, Float b) { return a.v / b.v; }
  friend GATELIGHT_INLINE Float operator-(Float a) { return -a.v; }
  GATELIGHT_INLINE Float& operator+=(Float b) { return *this = *this + b; }
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
#if defined(__AVX2__)
  return GATELIGHT_SIMD(min_ps)(a.v, b.v);
#elif defined(__SSE2__)
  return _mm_min_ps(a.v, b.v);
#else
  return select(a < b, a, b);
#endif
}
GATELIGHT_INLINE Float max(Float a, Float b) {
#if defined(__AVX2__)
  return GATELIGHT_SIMD(max_ps)(a.v, b.v);
#elif defined(__SSE2__)
  return _mm_max_ps(a.v, b.v);
#else
  return select(a > b, a, b);
#endif
}
GATELIGHT_INLINE Float sqrt(Float a) {
#if defined(__AVX2__)
  return GATELIGHT_SIMD(sqrt_ps)(a.v);
#elif defined(__SSE2__)
  return _mm_sqrt_ps(a.v);
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
/// Towards zero. The magnitude is below 2^31.
GATELIGHT_INLINE Int to_int(Float a) {
  return (Words) __builtin_convertvector(a.v, SignedWords);
}
/// The number counts as signed.
GATELIGHT_INLINE Float to_float(Int a) {
  return __builtin_convertvector((SignedWords)a.v, FloatRegister);
}
/// The upper half of the product.
GATELIGHT_INLINE Int multiply_high(Int a, Int b) {
#if defined(__AVX2__)
  const auto even = (Pairs)GATELIGHT_SIMD(mul_epu32)((IntRegister)a.v, (IntRegister)b.v);
  const auto odd =
      (Pairs)GATELIGHT_SIMD(mul_epu32)((IntRegister)((Pairs)a.v >> 32), (IntRegister)((Pairs)b.v >> 32));
#elif defined(__SSE2__)
  const auto even = (Pairs)_mm_mul_epu32((IntRegister)a.v, (IntRegister)b.v);
  const auto odd = (Pairs)_mm_mul_epu32((IntRegister)((Pairs)a.v >> 32), (IntRegister)((Pairs)b.v >> 32));
#else
  const Pairs even = ((Pairs)a.v & 0xffffffffu) * ((Pairs)b.v & 0xffffffffu);
  const Pairs odd = ((Pairs)a.v >> 32) * ((Pairs)b.v >> 32);
#endif
  return (Words)((even >> 32) | (odd & ~uint64_t{0xffffffffu}));
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

/// Four numbers from each of kLanes / 4 addresses: address(0), address(1) ...
template <class Address>
GATELIGHT_INLINE Float load_groups4(Address address) {
#if defined(__AVX512F__)
  __m512 r = _mm512_castps128_ps512(_mm_loadu_ps(address(0)));
  r = _mm512_insertf32x4(r, _mm_loadu_ps(address(1)), 1);
  r = _mm512_insertf32x4(r, _mm_loadu_ps(address(2)), 2);
  return _mm512_insertf32x4(r, _mm_loadu_ps(address(3)), 3);
#elif defined(__AVX2__)
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(address(0))), _mm_loadu_ps(address(1)), 1);
#else
  return load(address(0));
#endif
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
  /// The four floats at p[first + offset] of each lane. A quarter of the reads of four gathers.
  GATELIGHT_INLINE Float4 four(const float* p, uint32_t offset) const {
    const auto row = [&](int j) __attribute__((always_inline)) {
      return load_groups4([&](int k)
                              __attribute__((always_inline)) { return p + offset + first[j + 4 * k]; });
    };
    return transpose4(row(0), row(1), row(2), row(3));
  }
};

}  // namespace

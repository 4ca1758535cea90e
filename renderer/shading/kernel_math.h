#pragma once
// Vectors in space, elementary functions and warps on lanes: the SIMD version of renderer/sampling/warp.h.
// Part of kernel_table.cpp.

#include "base/simd/vectors.h"

namespace {

constexpr float kPi = 3.14159265358979323846f;
constexpr float kInvPi = 1.0f / kPi;
constexpr float kTwoPi = 2.0f * kPi;
constexpr float kBelowOne = 0x1.fffffep-1f;
constexpr float kInfinite = __builtin_inff();

/// A vector in space, or a colour.
struct Float3 {
  Float x, y, z;

  friend GATELIGHT_INLINE Float3 operator+(Float3 a, Float3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend GATELIGHT_INLINE Float3 operator-(Float3 a, Float3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend GATELIGHT_INLINE Float3 operator*(Float3 a, Float3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend GATELIGHT_INLINE Float3 operator*(Float3 a, Float s) { return {a.x * s, a.y * s, a.z * s}; }
  friend GATELIGHT_INLINE Float3 operator-(Float3 a) { return {-a.x, -a.y, -a.z}; }
  GATELIGHT_INLINE Float3& operator+=(Float3 b) { return *this = *this + b; }
  GATELIGHT_INLINE Float3& operator*=(Float s) { return *this = *this * s; }
};

GATELIGHT_INLINE Float3 repeat(Float a) {
  return {a, a, a};
}
GATELIGHT_INLINE Float dot(Float3 a, Float3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
GATELIGHT_INLINE Float3 cross(Float3 a, Float3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
GATELIGHT_INLINE Float3 normalize(Float3 a) {
  return a * (1.0f / sqrt(dot(a, a)));
}
GATELIGHT_INLINE Float luminance(Float3 c) {
  return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}
GATELIGHT_INLINE Float largest(Float3 c) {
  return max(c.x, max(c.y, c.z));
}
GATELIGHT_INLINE Mask any_positive(Float3 c) {
  return (c.x > 0.0f) | (c.y > 0.0f) | (c.z > 0.0f);
}
GATELIGHT_INLINE Float3 clamp(Float3 a, Float low, Float high) {
  return {clamp(a.x, low, high), clamp(a.y, low, high), clamp(a.z, low, high)};
}
GATELIGHT_INLINE Float3 select(Mask m, Float3 a, Float3 b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
GATELIGHT_INLINE Float3 select_or_zero(Mask m, Float3 a) {
  return {select_or_zero(m, a.x), select_or_zero(m, a.y), select_or_zero(m, a.z)};
}
template <int kWidth>
GATELIGHT_INLINE Float3 load(const float (&a)[3][kWidth], int at) {
  return {load(a[0] + at), load(a[1] + at), load(a[2] + at)};
}
template <int kWidth>
GATELIGHT_INLINE void store(float (&a)[3][kWidth], int at, Float3 value) {
  store(a[0] + at, value.x);
  store(a[1] + at, value.y);
  store(a[2] + at, value.z);
}
template <int kWidth>
GATELIGHT_INLINE void store(uint32_t (&a)[kWidth], int at, Mask value) {
  store(a + at, words_of(value));
}

/// The hash of renderer/surface/ray.h.
GATELIGHT_INLINE Int hash(Int x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}
GATELIGHT_INLINE Float to_unit_float(Int x) {
  return to_float(x >> 8) * 0x1p-24f;
}

struct CosSin {
  Float cos, sin;
};
/// Cosine and sine of an angle in [-pi/4, pi/4], as cos_sin_octant() of warp.h.
GATELIGHT_INLINE CosSin cos_sin_octant(Float angle) {
  const Float x = angle * angle;
  return {1.0f + x * (-0.5f + x * (1.0f / 24.0f + x * (-1.0f / 720.0f + x * (1.0f / 40320.0f)))),
          angle * (1.0f + x * (-1.0f / 6.0f +
                               x * (1.0f / 120.0f + x * (-1.0f / 5040.0f + x * (1.0f / 362880.0f)))))};
}
/// Cosine and sine of 2 pi u, u in [0, 1].
GATELIGHT_INLINE CosSin cos_sin_turn(Float u) {
  const Int quadrant = to_int(u * 4.0f + 0.5f);
  const CosSin t = cos_sin_octant((u - 0.25f * to_float(quadrant)) * kTwoPi);
  const Mask odd = mask_of(Int(0u) - (quadrant & 1u));
  const Float a = select(odd, t.sin, t.cos), b = select(odd, t.cos, t.sin);
  // The cosine is negative in the second and third quadrant, the sine in the third and fourth.
  const Int cos_sign = ((quadrant + 1u) & 2u) << 30, sin_sign = (quadrant & 2u) << 30;
  return {float_of(bits_of(a) ^ cos_sign), float_of(bits_of(b) ^ sin_sign)};
}
/// atan2 for y >= 0, in [0, pi], within 3e-7: the rational argument of Cephes' atanf and its polynomial.
GATELIGHT_INLINE Float arc_tangent(Float y, Float x) {
  const Float ax = absolute(x);
  const Float a = min(y, ax) / max(max(y, ax), 1e-30f);
  const Mask big = a > 0.41421356f;
  const Float t = select(big, (a - 1.0f) / (a + 1.0f), a);
  const Float z = t * t;
  Float p = (((8.05374449538e-2f * z - 1.38776856032e-1f) * z + 1.99777106478e-1f) * z - 3.33329491539e-1f) *
                z * t +
            t;
  p = select(big, p + 0.25f * kPi, p);
  p = select(y > ax, 0.5f * kPi - p, p);
  return select(x < 0.0f, kPi - p, p);
}
/// The binary logarithm of a normal number above 0, within 2e-7 of the result or 1e-7.
GATELIGHT_INLINE Float log2(Float x) {
  // x = 2^e m with m in [sqrt(1/2), sqrt(2)); log2(m) is a series in (m - 1) / (m + 1).
  const Int shifted = bits_of(x) - 0x3f3504f3u;
  const Float e = to_float((shifted >> 23) - ((shifted >> 31) << 9));
  const Float m = float_of((shifted & 0x7fffffu) + 0x3f3504f3u);
  const Float s = (m - 1.0f) / (m + 1.0f), s2 = s * s;
  const Float series = 1.0f + s2 * (1.0f / 3.0f + s2 * (0.2f + s2 * (1.0f / 7.0f + s2 * (1.0f / 9.0f))));
  return e + s * series * 2.885390081777927f;
}
/// 2^x for x <= 127, within 2e-7 of the result; below -126 the result is 0.
GATELIGHT_INLINE Float exp2(Float x) {
  const Float bounded = max(x, -126.0f);
  const Int biased = to_int(bounded + 127.5f);
  const Float f = (bounded - (to_float(biased) - 127.0f)) * 0.6931471805599453f;
  const Float e =
      1.0f +
      f * (1.0f + f * (0.5f + f * (1.0f / 6.0f +
                                   f * (1.0f / 24.0f +
                                        f * (1.0f / 120.0f + f * (1.0f / 720.0f + f * (1.0f / 5040.0f)))))));
  return select_or_zero(x >= -126.0f, e * float_of(biased << 23));
}

/// An orthonormal basis around a unit normal: Basis of warp.h.
struct Frame {
  Float3 tangent, bitangent, normal;

  GATELIGHT_INLINE explicit Frame(Float3 n) : normal(n) {
    const Float sign = sign_of(n.z);
    const Float a = -1.0f / (sign + n.z);
    const Float b = n.x * n.y * a;
    tangent = {1.0f + sign * n.x * n.x * a, sign * b, -(sign * n.x)};
    bitangent = {b, sign + n.y * n.y * a, -n.y};
  }
  GATELIGHT_INLINE Float3 to_world(Float3 local) const {
    return tangent * local.x + bitangent * local.y + normal * local.z;
  }
};

/// sample_cosine_hemisphere() of warp.h.
GATELIGHT_INLINE Float3 sample_cosine_hemisphere(Float u, Float v) {
  const Float a = 2.0f * u - 1.0f, b = 2.0f * v - 1.0f;
  const Mask wide = absolute(a) > absolute(b);
  const Float radius = select(wide, a, b), other = select(wide, b, a);
  const CosSin t = cos_sin_octant(0.25f * kPi * select(radius == 0.0f, 0.0f, other / radius));
  const Float x = radius * select(wide, t.cos, t.sin), y = radius * select(wide, t.sin, t.cos);
  return {x, y, sqrt(max(0.0f, 1.0f - (x * x + y * y)))};
}
GATELIGHT_INLINE Float3 sample_uniform_hemisphere(Float u, Float v) {
  const Float r = sqrt(max(0.0f, 1.0f - u * u));
  const CosSin t = cos_sin_turn(v);
  return {r * t.cos, r * t.sin, u};
}
GATELIGHT_INLINE Float3 sample_uniform_sphere(Float u, Float v) {
  const Float r = 2.0f * sqrt(max(0.0f, u * (1.0f - u)));
  const CosSin t = cos_sin_turn(v);
  return {r * t.cos, r * t.sin, 1.0f - 2.0f * u};
}

}  // namespace

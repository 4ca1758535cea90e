// Inputs besides the features. Arctangents are the CPU's polynomial, because Vulkan guarantees the built-in
// one only to 2^-11.

const uint kIdentity = 0;
const uint kOneBlob = 1;
const uint kSphericalOneBlob = 2;

// atan(a) for a in [0,1]; the error is 1.1e-7.
float arctangent_unit(float a) {
  const float z = a * a;
  float p = 0.0028340643;
  p = fma(p, z, -0.0160050305);
  p = fma(p, z, 0.0425876075);
  p = fma(p, z, -0.0749544544);
  p = fma(p, z, 0.106367541);
  p = fma(p, z, -0.142025705);
  p = fma(p, z, 0.199924836);
  p = fma(p, z, -0.333330668);
  p = fma(p, z, 0.999999984);
  return p * a;
}

// atan2(y, x) in (-pi, pi]; 0 for (0, 0).
float arctangent(float y, float x) {
  const float ax = abs(x), ay = abs(y);
  float angle = arctangent_unit(min(ax, ay) / max(max(ax, ay), 1e-37));
  if (ax < ay) angle = 1.57079632679 - angle;
  if (x < 0.0) angle = 3.14159265359 - angle;
  return y < 0.0 ? -angle : angle;
}

// (theta / pi, phi / 2 pi), the second in [0, 1).
vec2 spherical(vec3 d) {
  const float theta = arctangent(sqrt(fma(d.x, d.x, d.y * d.y)), d.z);
  const float phi = arctangent(d.y, d.x) * 0.159154943092;
  return vec2(theta * 0.318309886184, phi < 0.0 ? phi + 1.0 : phi);
}

// Integral of the quartic kernel 15/16 (1 - u^2)^2 from -1 to u; between 0 and 1.
float quartic_primitive(float u) {
  u = clamp(u, -1.0, 1.0);
  const float z = u * u;
  const float p = fma(fma(z, 0.2, -2.0 / 3.0), z, 1.0);
  return fma(u * (15.0 / 16.0), p, 0.5);
}

// The part of a kernel of radius 1/size inside a bin whose centre has this distance from the kernel's.
float bin_share(float distance, float size) {
  return quartic_primitive(fma(distance, size, 0.5)) - quartic_primitive(fma(distance, size, -0.5));
}

float one_blob(float x, uint bin, uint bins, bool wraps) {
  const float size = float(bins);
  float distance = (float(bin) + 0.5) * (1.0 / size) - x;
  if (!wraps) return bin_share(distance, size);
  distance -= roundEven(distance);
  float share = bin_share(distance, size);
  // With two bins on a circle the kernel reaches a bin from both sides.
  if (bins == 2u) share += bin_share(distance + 1.0, size) + bin_share(distance - 1.0, size);
  return share;
}

// fp16 by integer arithmetic, equal on every driver: two halves per word, rounded to nearest even.

float half_to_float(uint half_bits) {
  const uint sign = (half_bits & 0x8000u) << 16;
  const uint exponent = half_bits >> 10 & 0x1fu;
  const uint mantissa = half_bits & 0x3ffu;
  if (exponent == 0u) {
    const float magnitude = float(mantissa) * 5.9604644775390625e-8;  // 2^-24
    return uintBitsToFloat(floatBitsToUint(magnitude) | sign);
  }
  return uintBitsToFloat(sign | exponent + 112u << 23 | mantissa << 13);
}

// |value| must be at most the largest half.
uint float_to_half(float value) {
  const uint bits = floatBitsToUint(value);
  const uint sign = bits >> 16 & 0x8000u;
  const uint magnitude = bits & 0x7fffffffu;
  if (magnitude < 0x38800000u) {
    // Subnormal: the sum with 0.5 has the rounded mantissa in its lowest bits.
    precise const float shifted = uintBitsToFloat(magnitude) + 0.5;
    return sign | floatBitsToUint(shifted) - 0x3f000000u;
  }
  return sign | magnitude - 0x38000000u + 0xfffu + (magnitude >> 13 & 1u) >> 13;
}

float first_half(uint word) {
  return half_to_float(word & 0xffffu);
}

float second_half(uint word) {
  return half_to_float(word >> 16);
}

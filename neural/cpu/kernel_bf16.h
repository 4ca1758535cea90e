#pragma once
// Forward pass in bf16: products of pairs are summed in fp32 (vdpbf16ps). Without this instruction, weights
// and activations are rounded in the same way and multiplied in fp32. Part of kernel_table.cpp.

#include "neural/cpu/kernel_network.h"

namespace {

#if defined(__AVX512BF16__)

GATELIGHT_INLINE void store_bf16(uint16_t* p, Float a) {
  const __m256bh rounded = _mm512_cvtneps_pbh(a.v);
  __builtin_memcpy(p, &rounded, sizeof rounded);
}

// Rows of activations are stored as bf16 in the buffers of the fp32 activations.
GATELIGHT_INLINE void forward_bf16(const KernelNetwork& n, const TileBuffers& b, float* inputs, uint32_t rows,
                                   const Between& between) {
  auto* x = reinterpret_cast<uint16_t*>(b.spare);
  for (uint32_t r = 0; r < rows; ++r)
    for (uint32_t c = 0; c < n.input_stride; c += kLanes)
      store_bf16(x + r * n.input_stride + c, load(inputs + r * n.input_stride + c));
  uint32_t stride = n.input_stride;
  const auto multiply_layer = [&](const KernelLayer& layer, auto&& finish) __attribute__((always_inline)) {
    with_stride(
        stride, [&](auto kStride) __attribute__((always_inline)) {
          multiply<decltype(kStride)::value>(x, rows, (layer.inputs + 1) / 2, layer.forward_bf16,
                                             layer.padded_outputs, layer.biases, layer.padded_outputs, finish,
                                             between);
        });
  };
  const Float slope = n.slope;
  for (uint32_t l = 0; l + 1 < n.layer_count; ++l) {
    auto* y = reinterpret_cast<uint16_t*>(b.hidden[l]);
    multiply_layer(
        n.layers[l], [&](uint32_t r, uint32_t c, Float a) __attribute__((always_inline)) {
          store_bf16(y + r * n.width + c, leaky(a, slope));
        });
    x = y;
    stride = n.width;
  }
  multiply_layer(
      n.layers[n.layer_count - 1], [&](uint32_t r, uint32_t c, Float a) __attribute__((always_inline)) {
        store(b.outputs + r * kOutputStride + c, a);
      });
}

#else

GATELIGHT_INLINE void forward_bf16(const KernelNetwork& n, const TileBuffers& b, float* inputs, uint32_t rows,
                                   const Between& between) {
  for (uint32_t i = 0; i < rows * n.input_stride; i += kLanes)
    store(inputs + i, round_to_bf16(load(inputs + i)));
  forward<true>(n, b, rows, between);
}

#endif

}  // namespace

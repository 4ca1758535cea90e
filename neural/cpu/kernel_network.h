#pragma once
// Forward and backward pass of the network for one tile. Part of kernel_table.cpp.

#include "base/simd/fused.h"
#include "base/simd/groups.h"
#include "neural/cpu/kernel_prefetch.h"
#include "neural/cpu/kernel_products.h"
#include "neural/cpu/kernels.h"

namespace {

using namespace gatelight::neural::cpu;

// Calls f with the row stride as a compile-time constant, so that the rows of a block are offsets from one
// pointer.
template <class F>
GATELIGHT_INLINE void with_stride(uint32_t stride, F&& f) {
  switch (stride) {
    case 16:
      return f(Constant<16>{});
    case 32:
      return f(Constant<32>{});
    case 64:
      return f(Constant<64>{});
    case 128:
      return f(Constant<128>{});
    default:
      return f(Constant<256>{});
  }
}

// The activations of a tile. The backward pass overwrites them with their gradients: with a second set of
// buffers, a tile of common networks would not fit into the L1 cache.
struct TileBuffers {
  const float* inputs;              // [kTile][input_stride]
  float* hidden[kMaxKernelLayers];  // [kTile][width]
  float* outputs;                   // [kTile][kOutputStride]
  float* spare;                     // as long as the inputs
};

GATELIGHT_INLINE Float leaky(Float a, Float slope) {
  return max(a, a * slope);
}

/// Rounds a finite value to the eight significant bits of bf16, ties to even.
GATELIGHT_INLINE Float round_to_bf16(Float a) {
  const Int word = bits_of(a);
  return float_of((word + ((word >> 16 & 1u) + 0x7fffu)) & 0xffff0000u);
}

// y = activation(x W + b).
template <bool kRounded>
GATELIGHT_INLINE void forward_hidden(const KernelLayer& layer, const float* x, uint32_t x_stride, float* y,
                                     uint32_t y_stride, uint32_t rows, float slope, const Between& between) {
  const Float s = slope;
  with_stride(
      x_stride, [&](auto stride) __attribute__((always_inline)) {
        multiply<decltype(stride)::value>(
            x, rows, layer.inputs, kRounded ? layer.forward_rounded : layer.forward, layer.padded_outputs,
            layer.biases, layer.padded_outputs,
            [&](uint32_t r, uint32_t c, Float a) __attribute__((always_inline)) {
              const Float h = leaky(a, s);
              store(y + r * y_stride + c, kRounded ? round_to_bf16(h) : h);
            },
            between);
      });
}

// Whether a last layer with up to four outputs has code of its own. With four lanes it is like other layers.
constexpr bool kFewOutputs = kLanes > 4;

// With up to four outputs most lanes of a vector would be idle. Here lanes are inputs: each lane of a group
// of four sums one output over every fourth input, and the groups are added at the end.
template <bool kRounded, uint32_t kVectors>
GATELIGHT_NOINLINE void forward_few_outputs(const KernelLayer& layer, const float* x, uint32_t x_stride,
                                            float* y, uint32_t rows) {
  Float w[4 * kVectors];
  const float* packed = kRounded ? layer.forward_groups_rounded : layer.forward_groups;
#pragma GCC unroll 8
  for (uint32_t v = 0; v < kVectors; ++v)
#pragma GCC unroll 4
    for (uint32_t q = 0; q < 4; ++q)
      w[4 * v + q] = load(packed + (v * kLanes / 16 * 4 + q) * 16 + v * kLanes % 16);
  const Float bias = load_first4(layer.biases);
#pragma GCC unroll 2
  for (uint32_t r = 0; r < rows; ++r) {
    Float even = bias, odd = 0.0f;
#pragma GCC unroll 8
    for (uint32_t v = 0; v < kVectors; ++v) {
      const Float h = load(x + r * x_stride + v * kLanes);
      even = fma(repeat4<0>(h), w[4 * v], even);
      odd = fma(repeat4<1>(h), w[4 * v + 1], odd);
      even = fma(repeat4<2>(h), w[4 * v + 2], even);
      odd = fma(repeat4<3>(h), w[4 * v + 3], odd);
    }
    store_sum4(y + r * kOutputStride, even + odd);
  }
}

template <bool kRounded>
GATELIGHT_INLINE void forward_output(const KernelLayer& layer, const float* x, uint32_t x_stride, float* y,
                                     uint32_t rows, const Between& between) {
  if (kFewOutputs && layer.forward_groups != nullptr) {
    switch (layer.inputs / kLanes) {
      case 1:
        forward_few_outputs<kRounded, 1>(layer, x, x_stride, y, rows);
        break;
      case 2:
        forward_few_outputs<kRounded, 2>(layer, x, x_stride, y, rows);
        break;
      case 4:
        forward_few_outputs<kRounded, 4>(layer, x, x_stride, y, rows);
        break;
      case 8:
        forward_few_outputs<kRounded, 8>(layer, x, x_stride, y, rows);
        break;
      default:
        forward_few_outputs<kRounded, 16>(layer, x, x_stride, y, rows);
        break;
    }
    between();
    return;
  }
  with_stride(
      x_stride, [&](auto stride) __attribute__((always_inline)) {
        multiply<decltype(stride)::value>(
            x, rows, layer.inputs, kRounded ? layer.forward_rounded : layer.forward, kOutputStride,
            layer.biases, kOutputStride,
            [&](uint32_t r, uint32_t c, Float a)
                __attribute__((always_inline)) { store(y + r * kOutputStride + c, a); },
            between);
      });
}

template <bool kRounded>
GATELIGHT_INLINE void forward(const KernelNetwork& n, const TileBuffers& b, uint32_t rows,
                              const Between& between) {
  const float* x = b.inputs;
  uint32_t stride = n.input_stride;
  for (uint32_t l = 0; l + 1 < n.layer_count; ++l) {
    forward_hidden<kRounded>(n.layers[l], x, stride, b.hidden[l], n.width, rows, n.slope, between);
    x = b.hidden[l];
    stride = n.width;
  }
  forward_output<kRounded>(n.layers[n.layer_count - 1], x, stride, b.outputs, rows, between);
}

// Backward pass of a last layer with up to four outputs, in one pass over the activations below. Their
// gradients overwrite them, and weight gradients stay in registers.
template <uint32_t kVectors>
GATELIGHT_NOINLINE void backward_few_outputs(const KernelLayer& layer, const float* d, float* h,
                                             uint32_t width, uint32_t rows, float slope, float* gradients,
                                             float* bias_gradients) {
  const Float one = 1.0f, leak = slope;
  for (uint32_t c = 0; c < width; c += kVectors * kLanes) {
    Float w[4][kVectors], g[4][kVectors];
#pragma GCC unroll 4
    for (uint32_t o = 0; o < 4; ++o)
#pragma GCC unroll 2
      for (uint32_t v = 0; v < kVectors; ++v) {
        const uint64_t at = uint64_t{o} * layer.padded_inputs + c + v * kLanes;
        w[o][v] = o < layer.outputs ? load(layer.backward + at) : Float(0.0f);
        g[o][v] = load(gradients + at);
      }
    for (uint32_t r = 0; r < rows; ++r) {
      Float y[4];
#pragma GCC unroll 4
      for (uint32_t o = 0; o < 4; ++o) y[o] = d[r * kOutputStride + o];
#pragma GCC unroll 2
      for (uint32_t v = 0; v < kVectors; ++v) {
        float* at = h + r * width + c + v * kLanes;
        const Float active = load(at);
#pragma GCC unroll 4
        for (uint32_t o = 0; o < 4; ++o) g[o][v] = fma(y[o], active, g[o][v]);
        const Float below = fma(y[0], w[0][v], y[1] * w[1][v]);
        const Float other = fma(y[2], w[2][v], y[3] * w[3][v]);
        store(at, (below + other) * select(active > 0.0f, one, leak));
      }
    }
#pragma GCC unroll 4
    for (uint32_t o = 0; o < 4; ++o)
#pragma GCC unroll 2
      for (uint32_t v = 0; v < kVectors; ++v)
        store(gradients + uint64_t{o} * layer.padded_inputs + c + v * kLanes, g[o][v]);
  }
  Float even = load_first4(bias_gradients), odd = 0.0f;
  for (uint32_t r = 0; r < rows; r += 2) {
    even += load_first4(d + r * kOutputStride);
    odd += load_first4(d + (r + 1) * kOutputStride);
  }
  store_partial(bias_gradients, even + odd, 4);
}

// Propagates the gradients in `outputs`. Gradients of weights and biases are added to `gradients`;
// finish_features(row, column, value) receives those of the feature inputs. `rows` is a multiple of
// kBlockRows, hence even.
template <class FinishFeatures>
GATELIGHT_INLINE void backward(const KernelNetwork& n, const TileBuffers& b, uint32_t rows, float* gradients,
                               FinishFeatures&& finish_features, const Between& between) {
  const uint32_t last = n.layer_count - 1;
  const KernelLayer& output = n.layers[last];
  const uint32_t width = n.width;
  const Float one = 1.0f, slope = n.slope;

  // Propagates through a layer's weights and the activation of the layer below, whose values it overwrites
  // with gradients.
  const auto descend = [&](const KernelLayer& layer, const float* d, auto stride, float* h)
      __attribute__((always_inline)) {
    multiply<decltype(stride)::value>(
        d, rows, layer.outputs, layer.backward, layer.padded_inputs, nullptr, width,
        [&](uint32_t r, uint32_t c, Float a) __attribute__((always_inline)) {
          float* at = h + r * width + c;
          store(at, a * select(load(at) > 0.0f, one, slope));
        },
        between);
  };
  float* const output_gradients = gradients + output.gradient;
  float* const output_biases = gradients + output.bias_gradient;
  constexpr uint32_t kFewVectors =
      kLanes == 16 ? 2 : 1;  // 8 vectors each of weights and gradients with AVX-512, 4 with AVX2
  if (kFewOutputs && output.outputs <= 4) {
    if (width % (kFewVectors * kLanes) == 0)
      backward_few_outputs<kFewVectors>(output, b.outputs, b.hidden[last - 1], width, rows, n.slope,
                                        output_gradients, output_biases);
    else
      backward_few_outputs<1>(output, b.outputs, b.hidden[last - 1], width, rows, n.slope, output_gradients,
                              output_biases);
    between();
  } else {
    float unused[kMaxWidth] = {};  // receives the sums of activations
    add_outer(output_gradients, output.padded_inputs, b.outputs, kOutputStride, output.outputs,
              b.hidden[last - 1], width, width, rows, unused, between);
    for (uint32_t r = 0; r < rows; ++r)
      for (uint32_t c = 0; c < output.outputs; ++c) output_biases[c] += b.outputs[r * kOutputStride + c];
    descend(output, b.outputs, Constant<kOutputStride>{}, b.hidden[last - 1]);
  }

  for (uint32_t l = last; l-- > 0;) {
    const float* d = b.hidden[l];
    const KernelLayer& layer = n.layers[l];
    const float* x = l == 0 ? b.inputs : b.hidden[l - 1];
    const uint32_t x_stride = l == 0 ? n.input_stride : width;
    add_outer(gradients + layer.gradient, layer.padded_outputs, x, x_stride, layer.inputs, d, width, width,
              rows, gradients + layer.bias_gradient, between);
    if (l > 0) {
      with_stride(
          width, [&](auto stride)
                     __attribute__((always_inline)) { descend(layer, d, stride, b.hidden[l - 1]); });
    } else if (n.feature_inputs > 0) {
      const uint32_t columns = (n.feature_inputs + 15) / 16 * 16;
      with_stride(
          width, [&](auto stride) __attribute__((always_inline)) {
            multiply<decltype(stride)::value>(d, rows, layer.outputs, layer.backward, layer.padded_inputs,
                                              nullptr, columns, finish_features, between);
          });
    }
  }
}

}  // namespace

#pragma once
// Forward and backward through the network for one tile. Part of kernels.cpp.

#include "neural/cpu/kernel_products.h"
#include "neural/cpu/kernels.h"

namespace {

using namespace gatelight::neural::cpu;

// Row strides are compile-time constants, so that the rows of a block are displacements from one pointer.
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

struct NoBetween {
  __attribute__((always_inline)) void operator()() const {}
};

// Where the activations of a tile lie.
struct TileBuffers {
  float* inputs;                    // [kTile][input_stride]
  float* hidden[kMaxKernelLayers];  // [kTile][width]
  float* outputs;                   // [kTile][kOutputStride]
  float* output_gradients;          // [kTile][kOutputStride]
  float* gradients[2];              // [kTile][width]
};

GATELIGHT_INLINE Float leaky(Float a, Float slope) {
  return max(a, mul(a, slope));
}

// y = activation(x W + b).
template <bool kRounded, class Between>
GATELIGHT_INLINE void forward_hidden(const KernelLayer& layer, const float* x, uint32_t x_stride, float* y,
                                     uint32_t y_stride, uint32_t rows, float slope, Between&& between) {
  const Float s = broadcast(slope);
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

template <bool kRounded, class Between>
GATELIGHT_INLINE void forward_output(const KernelLayer& layer, const float* x, uint32_t x_stride, float* y,
                                     uint32_t rows, Between&& between) {
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

template <bool kRounded, class Between>
GATELIGHT_INLINE void forward(const KernelNetwork& n, const TileBuffers& b, uint32_t rows,
                              Between&& between) {
  const float* x = b.inputs;
  uint32_t stride = n.input_stride;
  for (uint32_t l = 0; l + 1 < n.layer_count; ++l) {
    forward_hidden<kRounded>(n.layers[l], x, stride, b.hidden[l], n.width, rows, n.slope, between);
    x = b.hidden[l];
    stride = n.width;
  }
  forward_output<kRounded>(n.layers[n.layer_count - 1], x, stride, b.outputs, rows, between);
}

GATELIGHT_INLINE void add_columns(float* sums, const float* d, uint32_t stride, uint32_t columns,
                                  uint32_t rows) {
  for (uint32_t c = 0; c < columns; c += kLanes) {
    Float even = load(sums + c), odd = zero();
    for (uint32_t r = 0; r + 1 < rows; r += 2) {
      even = add(even, load(d + r * stride + c));
      odd = add(odd, load(d + (r + 1) * stride + c));
    }
    store(sums + c, add(even, odd));
  }
}

// From output_gradients to the gradients of weights and biases (added to `gradients`) and of the feature
// inputs, which finish_features(row, column, value) takes. rows is a multiple of kBlockRows and so even.
template <class FinishFeatures, class Between>
GATELIGHT_INLINE void backward(const KernelNetwork& n, const TileBuffers& b, uint32_t rows, float* gradients,
                               FinishFeatures&& finish_features, Between&& between) {
  const uint32_t last = n.layer_count - 1;
  const KernelLayer& output = n.layers[last];
  const uint32_t width = n.width;
  const Float one = broadcast(1.0f), slope = broadcast(n.slope);

  add_outer(gradients + output.gradient, output.padded_inputs, b.output_gradients, kOutputStride,
            output.outputs, b.hidden[last - 1], width, width, rows, between);
  add_columns(gradients + output.bias_gradient, b.output_gradients, kOutputStride, kOutputStride, rows);

  // Through a layer's weights and the activation of the layer below.
  const auto descend = [&](const KernelLayer& layer, const float* d, auto stride, const float* h,
                           float* below) __attribute__((always_inline)) {
    multiply<decltype(stride)::value>(
        d, rows, layer.outputs, layer.backward, layer.padded_inputs, nullptr, width,
        [&](uint32_t r, uint32_t c, Float a) __attribute__((always_inline)) {
          const Float active = load(h + r * width + c);
          store(below + r * width + c, mul(a, select(less(zero(), active), one, slope)));
        },
        between);
  };
  float* d = b.gradients[0];
  descend(output, b.output_gradients, Constant<kOutputStride>{}, b.hidden[last - 1], d);

  for (uint32_t l = last; l-- > 0;) {
    const KernelLayer& layer = n.layers[l];
    const float* x = l == 0 ? b.inputs : b.hidden[l - 1];
    const uint32_t x_stride = l == 0 ? n.input_stride : width;
    add_outer(gradients + layer.gradient, layer.padded_outputs, x, x_stride, layer.inputs, d, width, width,
              rows, between);
    add_columns(gradients + layer.bias_gradient, d, width, width, rows);
    if (l > 0) {
      float* below = d == b.gradients[0] ? b.gradients[1] : b.gradients[0];
      with_stride(
          width, [&](auto stride)
                     __attribute__((always_inline)) { descend(layer, d, stride, b.hidden[l - 1], below); });
      d = below;
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

#pragma once
// Computes z = sum of w_t z_t (paper, eq. 1) for a tile and writes the levels to the first columns of the
// inputs. Part of kernel_table.cpp.

#include "neural/cpu/kernel_short_vectors.h"
#include "neural/cpu/kernels.h"

namespace {

using namespace gatelight::neural::cpu;

template <uint32_t kNodes, class Element>
GATELIGHT_NOINLINE void interpolate_rows(const Element* features, uint64_t feature_stride, uint32_t length,
                                         uint32_t levels, const uint32_t* nodes, const float* weights,
                                         float* inputs, uint32_t stride) {
  for (uint32_t s = 0; s < kTile; ++s) {
    float* row = inputs + s * stride;
    for (uint32_t l = 0; l < levels; ++l, row += length) {
      const uint32_t* node = nodes + l * kNodes * kTile + s;
      const float* weight = weights + l * kNodes * kTile + s;
      for_parts(
          length, [&](auto part, uint32_t at) __attribute__((always_inline)) {
            using V = decltype(part);
            V z = load_short<V>(features + node[0] * feature_stride + at) * weight[0];
            for (uint32_t n = 1; n < kNodes; ++n)
              z = z + load_short<V>(features + node[n * kTile] * feature_stride + at) * weight[n * kTile];
            store_short(row + at, z);
          });
    }
  }
}

template <class Element>
GATELIGHT_INLINE void interpolate_from(const KernelEncoder& e, const Element* features, const uint32_t* nodes,
                                       const float* weights, float* inputs, uint32_t stride) {
  if (e.encoding == KernelEncoding::hash_grid) {
    if (e.features == 4)
      interpolate_rows<8>(features, e.feature_stride, 4, e.levels, nodes, weights, inputs, stride);
    else
      interpolate_rows<8>(features, e.feature_stride, e.features, e.levels, nodes, weights, inputs, stride);
    return;
  }
  switch (e.features) {
    case 2:
      return interpolate_rows<3>(features, e.feature_stride, 2, e.levels, nodes, weights, inputs, stride);
    case 4:
      return interpolate_rows<3>(features, e.feature_stride, 4, e.levels, nodes, weights, inputs, stride);
    case 8:
      return interpolate_rows<3>(features, e.feature_stride, 8, e.levels, nodes, weights, inputs, stride);
    default:
      return interpolate_rows<3>(features, e.feature_stride, e.features, e.levels, nodes, weights, inputs,
                                 stride);
  }
}

GATELIGHT_INLINE void interpolate(const KernelEncoder& e, const uint32_t* nodes, const float* weights,
                                  float* inputs, uint32_t stride) {
  if (e.half_features != nullptr)
    interpolate_from(e, e.half_features, nodes, weights, inputs, stride);
  else
    interpolate_from(e, e.float_features, nodes, weights, inputs, stride);
}

}  // namespace

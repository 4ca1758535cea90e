#pragma once
// Sums feature gradients at their nodes and applies Adam. Part of kernel_table.cpp.

#include "neural/cpu/kernel_prefetch.h"
#include "neural/cpu/kernel_short_vectors.h"
#include "neural/cpu/kernels.h"

namespace {

using namespace gatelight::neural::cpu;

constexpr float kMaxHalf = 65504.0f;

template <class V>
GATELIGHT_INLINE bool finite_short(V v) {
  const V difference = v - v;
  float total = 0.0f;
  for (uint32_t i = 0; i < kShort<V>; ++i) total += lane_of(difference, i);
  return total == 0.0f;
}

template <class V>
GATELIGHT_INLINE V clamp_to_half(V v) {
  float lanes[kShort<V>];
  for (uint32_t i = 0; i < kShort<V>; ++i) {
    const float x = lane_of(v, i);
    lanes[i] = x > kMaxHalf ? kMaxHalf : x < -kMaxHalf ? -kMaxHalf : x;
  }
  return load_short<V>(lanes);
}

// Updates one node and clears its sums. If the gradient is not finite, nothing else changes and the result is
// false.
GATELIGHT_INLINE bool update_node(const KernelFeatureUpdate& u, uint64_t node, uint32_t length, float* sums,
                                  const KernelAdamStep& step) {
  bool usable = true;
  for_parts(
      length, [&](auto part, uint32_t at) __attribute__((always_inline)) {
        using V = decltype(part);
        const V g = load_short<V>(sums + at) * u.adam.gradient_scale;
        usable = usable && finite_short<V>(g * g);
      });
  if (usable) {
    for_parts(
        length, [&](auto part, uint32_t at) __attribute__((always_inline)) {
          using V = decltype(part);
          const V g = load_short<V>(sums + at) * u.adam.gradient_scale;
          float* moments = u.moments + node * u.moment_stride + at;
          V m = load_short<V>(moments);
          V v = load_short<V>(moments + length);
          m = m * u.adam.beta1 + g * (1.0f - u.adam.beta1);
          v = v * u.adam.beta2 + g * g * (1.0f - u.adam.beta2);
          store_short(moments, m);
          store_short(moments + length, v);
          const uint64_t index = node * u.feature_stride + at;
          V p = u.features_fp32 != nullptr ? load_short<V>(u.features_fp32 + index)
                                           : load_short<V>(u.features_fp16 + index);
          p = p - m * step.step / (sqrt_short<V>(v) + step.epsilon);
          if (u.features_fp16 != nullptr) {
            p = clamp_to_half(p);
            store_short(u.features_fp16 + index, p);
          }
          if (u.features_fp32 != nullptr)
            store_short(u.features_fp32 + index, p);
          else
            p = load_short<V>(u.features_fp16 + index);
          if (u.averages != nullptr || u.averages_fp16 != nullptr) {
            V a = u.averages != nullptr ? load_short<V>(u.averages + index)
                                        : load_short<V>(u.averages_fp16 + index);
            a = a + (p - a) * step.average_rate;
            if (u.averages != nullptr) store_short(u.averages + index, a);
            if (u.averages_fp16 != nullptr) store_short(u.averages_fp16 + index, a);
          }
        });
  }
  for_parts(
      length, [&](auto part, uint32_t at) __attribute__((always_inline)) {
        using V = decltype(part);
        store_short(sums + at, V{});
      });
  return usable;
}

GATELIGHT_INLINE void prefetch_node(const KernelFeatureUpdate& u, uint64_t node) {
  if (u.features_fp32 != nullptr) prefetch(u.features_fp32 + node * u.feature_stride);
  if (u.features_fp16 != nullptr) prefetch(u.features_fp16 + node * u.feature_stride);
  if (u.averages != nullptr && u.feature_stride == u.features) prefetch(u.averages + node * u.feature_stride);
  prefetch(u.moments + node * u.moment_stride);
  if (u.step_stride == 1) prefetch(u.node_steps + node);
}

template <uint32_t kLength>
void update_features_of(const KernelFeatureUpdate& given) {
  const KernelFeatureUpdate u = given;  // a copy, which stores through its pointers cannot change
  const uint32_t length = kLength != 0 ? kLength : u.features;
  constexpr uint32_t kAhead = 32;

  // Sum in the order of the records, so that sums do not depend on threads.
  for (uint32_t i = 0; i < u.reference_count; ++i) {
    if (i + kAhead < u.reference_count) prefetch(u.feature_gradients + u.references[i + kAhead].source);
    const KernelReference& r = u.references[i];
    const uint32_t local = r.node - u.first_node;
    float* sum = u.sums + uint64_t{local} * length;
    const float* gradient = u.feature_gradients + r.source;
    for_parts(
        length, [&](auto part, uint32_t at) __attribute__((always_inline)) {
          using V = decltype(part);
          store_short(sum + at, load_short<V>(sum + at) + load_short<V>(gradient + at) * r.weight);
        });
    u.touched[local >> 6] |= uint64_t{1} << (local & 63);
    if (u.record_steps != nullptr) {
      const uint32_t step = u.record_steps[r.source / u.feature_inputs];
      if (u.step_scratch[local] < step) u.step_scratch[local] = step;
    }
  }

  uint32_t count = 0;
  for (uint32_t w = 0; w < u.node_count / 64 + 1; ++w) {
    for (uint64_t flags = u.touched[w]; flags != 0; flags &= flags - 1)
      u.touched_list[count++] = 64 * w + static_cast<uint32_t>(__builtin_ctzll(flags));
    u.touched[w] = 0;
  }
  *u.touched_count += count;

  if (u.dense != 0) {
    for (uint32_t local = 0; local < u.node_count; ++local)
      if (!update_node(u, u.first_node + local, length, u.sums + uint64_t{local} * length, u.dense_step))
        ++*u.skipped_count;
    return;
  }
  for (uint32_t i = 0; i < count && i < kAhead; ++i) prefetch_node(u, u.first_node + u.touched_list[i]);
  for (uint32_t i = 0; i < count; ++i) {
    if (i + kAhead < count) prefetch_node(u, u.first_node + u.touched_list[i + kAhead]);
    const uint32_t local = u.touched_list[i];
    const uint64_t node = u.first_node + local;
    uint32_t t = u.node_steps[node * u.step_stride];
    if (u.record_steps != nullptr) {
      t = u.step_scratch[local];
      u.step_scratch[local] = 0;
    } else if (t != 0xffffffffu) {
      ++t;
    }
    const KernelAdamStep step = t <= u.step_count ? u.steps[t] : u.late_step(u.late_context, t);
    if (update_node(u, node, length, u.sums + uint64_t{local} * length, step))
      u.node_steps[node * u.step_stride] = t;
    else
      ++*u.skipped_count;
  }
}

void update_features(const KernelFeatureUpdate& u) {
  switch (u.features) {
    case 2:
      return update_features_of<2>(u);
    case 4:
      return update_features_of<4>(u);
    case 8:
      return update_features_of<8>(u);
    default:
      return update_features_of<0>(u);
  }
}

}  // namespace

#pragma once
// The choice of a light by the light tree for all lanes: the SIMD version of renderer/light/light_tree.h.
// Part of kernel_table.cpp.

#include "base/simd/groups.h"
#include "renderer/shading/kernel_math.h"
#include "renderer/shading/kernel_sampler.h"
#include "renderer/shading/kernels.h"

namespace {

using gatelight::renderer::LightArraysPtr;

/// A point that receives light. The normal is zero where light may arrive from all sides; `free` is 1 there.
struct Receiver {
  Float3 p, n;
  Float free;
};

/// LightTree::weigh for one child of a node in each lane. field(i): number i of the child, in the order of
/// LightTree::Node.
template <class Field>
GATELIGHT_INLINE Float weigh(const Receiver& r, float nearest2, Field field) {
  const Float3 d = Float3{field(0), field(1), field(2)} - r.p;
  const Float radius = field(3);
  const Float distance2 = dot(d, d), radius2 = radius * radius;
  const Float strength = field(10) / max(max(distance2, radius2), nearest2);

  const Float safe2 = max(distance2, 1e-37f);
  const Float inverse = 1.0f / sqrt(safe2);
  const Float ratio2 = radius2 / safe2;
  const Mask inside = ratio2 >= 1.0f;
  const Float sin_b = select(inside, 0.0f, radius * inverse);
  const Float cos_b = select(inside, -1.0f, sqrt(max(0.0f, 1.0f - ratio2)));

  const Float along = -dot(d, {field(4), field(5), field(6)});
  const Float cos_w = max(along, field(9) * along) * inverse;
  const Float sin_w = sqrt(max(0.0f, distance2 - along * along)) * inverse;
  const Float cos_o = field(7);
  const Float sin_o = sqrt(max(0.0f, 1.0f - cos_o * cos_o));
  const Mask in_normals = cos_w > cos_o;
  const Float cos_x = select(in_normals, 1.0f, cos_w * cos_o + sin_w * sin_o);
  const Float sin_x = select(in_normals, 0.0f, sin_w * cos_o - cos_w * sin_o);
  const Float cos_emitted = select(cos_x > cos_b, 1.0f, cos_x * cos_b + sin_x * sin_b);
  const Float emitted = select_or_zero(cos_emitted > field(8), cos_emitted);

  const Float up = dot(d, r.n);
  const Float cos_i = up * inverse;
  const Float sin_i = sqrt(max(0.0f, distance2 - up * up)) * inverse;
  const Float cos_received = select(cos_i > cos_b, 1.0f, cos_i * cos_b + sin_i * sin_b);
  return strength * (emitted * max(r.free, cos_received));
}

/// The weights of a node's four children.
using Weights = Float4;

/// The weights of the root's children. All lanes share the root.
GATELIGHT_INLINE Weights weigh_root(const Receiver& r, const LightArraysPtr& view) {
  Weights w;
#pragma GCC unroll 1
  for (int c = 0; c < 4; ++c)
    w.c[c] = weigh(
        r, view.nearest2, [&](int i) __attribute__((always_inline)) { return Float(view.tree[4 * i + c]); });
  return w;
}

/// The weights for a different node in each lane. A node has its numbers in fours, so four lanes at a time
/// weigh the four children of their receivers; reading the numbers of each lane one by one would take four
/// times as many loads.
struct NodeWeigher {
  alignas(64) float receiver[7][kLanes];
  const LightArraysPtr& view;

  GATELIGHT_INLINE NodeWeigher(const Receiver& r, const LightArraysPtr& lights) : view(lights) {
    const Float parts[7] = {r.p.x, r.p.y, r.p.z, r.n.x, r.n.y, r.n.z, r.free};
    for (int i = 0; i < 7; ++i) store(receiver[i], parts[i]);
  }

  GATELIGHT_INLINE Weights operator()(Int node) const {
    const Records nodes(node * 48u);
    // Vector j has the lanes j, j + 4, j + 8 ...
    const auto row = [&](int j) __attribute__((always_inline)) {
      const auto part = [&](int i) __attribute__((always_inline)) {
        return repeat_groups4([&](int k) __attribute__((always_inline)) { return &receiver[i][j + 4 * k]; });
      };
      const auto field = [&](int i) __attribute__((always_inline)) {
        return load_groups4([&](int k) __attribute__((always_inline)) {
          return view.tree + nodes.first[j + 4 * k] + 4 * i;
        });
      };
      return weigh(Receiver{{part(0), part(1), part(2)}, {part(3), part(4), part(5)}, part(6)}, view.nearest2,
                   field);
    };
    Float rows[4];
#pragma GCC unroll 1
    for (int j = 0; j < 4; ++j) rows[j] = row(j);
    return transpose4(rows[0], rows[1], rows[2], rows[3]);
  }
};

/// Random digits that replace those which a choice has used up: choosing with probability p leaves steps of
/// 2^-24 / p, which one more number fills. Without this a deep tree would run out of digits.
struct Digits {
  Int state;

  GATELIGHT_INLINE Float refill(Float rest, Float inverse_probability) {
    state = hash(state + 0x9e3779b9u);
    return min(rest + to_unit_float(state) * (0x1p-24f * inverse_probability), kBelowOne);
  }
};

/// LightTree::sample. Changes `chosen` and multiplies `probability` where `open` is set; returns the lanes
/// for which no light is found.
GATELIGHT_INLINE Mask descend(const LightArraysPtr& view, const Receiver& r, Weights w, Mask open, Float u,
                              Digits& digits, Int& chosen, Float& probability) {
  const NodeWeigher weigh_node(r, view);
  Mask lost = no_lanes();
  Int node(0u);
  while (any(open)) {
    const Float w0 = w.c[0], w1 = w0 + w.c[1], w2 = w1 + w.c[2], w3 = w2 + w.c[3];
    const Mask some = w3 > 0.0f;
    lost |= open & ~some;
    open &= some;
    const Float target = u * w3;
    const Mask past0 = target >= w0, past1 = target >= w1, past2 = target >= w2;
    const Float low = select(past2, w2, select(past1, w1, select_or_zero(past0, w0)));
    const Float value = select(past2, w.c[3], select(past1, w.c[2], select(past0, w.c[1], w.c[0])));
    const Int slot = select(past2, Int(3u), select(past1, Int(2u), words_of(past0) & 1u));
    const Float inverse = w3 / value;
    u = digits.refill(min((target - low) / value, kBelowOne), inverse);
    probability = select(open, probability / inverse, probability);
    const Int child = gather(reinterpret_cast<const uint32_t*>(view.tree), node * 48u + 44u + slot);
    const Mask leaf = mask_of(Int(0u) - (child >> 31));
    chosen = select(open & leaf, child & 0x7fffffffu, chosen);
    open &= ~leaf;
    if (!any(open)) break;
    node = select(open, child, Int(0u));
    w = weigh_node(node);
  }
  return lost;
}

}  // namespace

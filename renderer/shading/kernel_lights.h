#pragma once
// Light samples for all lanes: the SIMD version of renderer/light (Lights::sample). Part of kernel_table.cpp.

#include "base/simd/groups.h"
#include "renderer/shading/kernel_light_tree.h"
#include "renderer/shading/kernel_math.h"
#include "renderer/shading/kernel_sampler.h"
#include "renderer/shading/kernels.h"

namespace {

using gatelight::renderer::LaneLight;
using gatelight::renderer::LightArraysPtr;
using gatelight::renderer::ShadingBlock;
using gatelight::renderer::ShadingContext;

GATELIGHT_INLINE Int state_of(LaneLight state) {
  return Int(static_cast<uint32_t>(state));
}

/// The result of a kind of light; lanes of other kinds are undefined.
struct LanesOfLight {
  Float3 wi, radiance;
  Float distance, pdf, offset, cosine;
  Float2 point;
  Mask valid, textured;  ///< textured: for triangles; for placed lights: with a profile
};

/// sample_triangle of Lights, with triangle_sampling.h. `choice` is the probability of the triangle.
GATELIGHT_INLINE LanesOfLight sample_triangles(const LightArraysPtr& view, Float3 p, Int light, Float choice,
                                               Float2 u, Mask here) {
  const Records record(light * static_cast<uint32_t>(LightArraysPtr::kTriangleFloats));
  const auto four = [&](uint32_t i) __attribute__((always_inline)) {
    return record.four(view.triangles, 4 * i);
  };
  const Float4 f0 = four(0), f1 = four(1), f2 = four(2), f3 = four(3), f4 = four(4);
  const Float3 corner = Float3{f0.c[0], f0.c[1], f0.c[2]} - p;
  const Float3 edge1{f0.c[3], f1.c[0], f1.c[1]}, edge2{f1.c[2], f1.c[3], f2.c[0]},
      normal{f2.c[1], f2.c[2], f2.c[3]};
  const Float area = f3.c[0];
  const Float3 pb = corner + edge1, pc = corner + edge2;
  const Float a2 = dot(corner, corner), b2 = dot(pb, pb), c2 = dot(pc, pc);

  // By area.
  const Mask up = u.y > u.x;
  const Float b0 = select(up, 0.5f * u.x, u.x - 0.5f * u.y);
  LanesOfLight s;
  s.point.x = select(up, u.y - 0.5f * u.x, 0.5f * u.y);
  s.point.y = 1.0f - b0 - s.point.x;
  Float pdf = 1.0f / area;
  s.valid = here;

  // By solid angle.
  Mask solid = here & ~(area < 3e-4f * min(a2, min(b2, c2)));
  if (any(solid)) {
    const Float ia = 1.0f / sqrt(a2), ib = 1.0f / sqrt(b2), ic = 1.0f / sqrt(c2);
    const Float3 a = corner * ia, b = pb * ib, c = pc * ic;
    const Float g0 = absolute(dot(a, cross(edge1 * ib, edge2 * ic)));
    const Float g1 = dot(a, c) + dot(b, c), g2 = 1.0f + dot(a, b);
    const Float omega = 2.0f * arc_tangent(g0, g1 + g2);
    solid &= (omega >= 3e-4f) & (omega <= 6.22f);
    const CosSin half = cos_sin_turn(omega * u.x * (0.5f / kTwoPi));
    const Float3 r = a * (g0 * half.cos - g1 * half.sin) + c * (g2 * half.sin);
    const Float norm2 = dot(r, r);
    const Float3 end = select(norm2 > 0.0f, r * (2.0f * dot(a, r) / norm2) - a, c);
    const Float3 chord = end - b;
    const Float whole = 0.5f * dot(chord, chord), part = u.y * whole, cos_end = 1.0f - whole;
    const Float scale = sqrt(max(0.0f, u.y * (2.0f - part) / max(2.0f - whole, 1e-12f)));
    const Float3 d = b * ((1.0f - part) - scale * cos_end) + end * scale;
    const Float3 q = cross(d, edge2);
    const Float determinant = dot(edge1, q);
    Float b1 = clamp(-dot(corner, q) / determinant, 0.0f, 1.0f);
    Float b2_ = clamp(-dot(d, cross(corner, edge1)) / determinant, 0.0f, 1.0f);
    const Float sum = b1 + b2_;
    const Float inside = select(sum > 1.0f, 1.0f / sum, 1.0f);
    s.valid &= ~(solid & (determinant == 0.0f));
    s.point.x = select(solid, b1 * inside, s.point.x);
    s.point.y = select(solid, b2_ * inside, s.point.y);
    pdf = select(solid, 1.0f / omega, pdf);
  }
  const Float3 to_light = corner + edge1 * s.point.x + edge2 * s.point.y;
  s.distance = sqrt(dot(to_light, to_light));
  s.wi = to_light * (1.0f / s.distance);
  const Float along = -dot(s.wi, normal);
  s.cosine = max(along, f4.c[1] * along);
  s.pdf = choice * select(solid, pdf, pdf * s.distance * s.distance / s.cosine);
  s.valid &= (s.distance > 0.0f) & (s.cosine > 0.0f) & (pdf > 0.0f) & (s.pdf > 0.0f) & (s.pdf < kInfinite);
  s.radiance = {f3.c[2], f3.c[3], f4.c[0]};
  s.offset = f3.c[1];
  s.textured = f4.c[2] > 0.0f;
  return s;
}

/// sample_placed of Lights, with punctual.h.
GATELIGHT_INLINE LanesOfLight sample_placed(const LightArraysPtr& view, Float3 p, Int light, Float choice,
                                            Mask here) {
  const Int at = light * static_cast<uint32_t>(LightArraysPtr::kPlacedFloats);
  const auto field = [&](uint32_t i) __attribute__((always_inline)) {
    return gather(view.placed + i, at);
  };
  const Float3 to_light = Float3{field(0), field(1), field(2)} - p;
  LanesOfLight s;
  s.distance = sqrt(dot(to_light, to_light));
  s.wi = to_light * (1.0f / s.distance);
  const Float x = s.distance * field(9), x2 = x * x;
  const Float window = clamp(1.0f - x2 * x2, 0.0f, 1.0f);
  const Float cos_angle = -dot(s.wi, {field(3), field(4), field(5)});
  const Float ramp = clamp((cos_angle - field(10)) / field(11), 0.0f, 1.0f);
  const Float factor = window / (s.distance * s.distance) * select(field(12) > 0.0f, ramp * ramp, 1.0f);
  s.radiance = Float3{field(6), field(7), field(8)} * factor;
  s.pdf = choice;
  s.offset = 1e-4f * s.distance;
  s.cosine = 1.0f;
  s.valid = here & (s.distance > 0.0f) & (largest(s.radiance) < kInfinite);
  s.textured = field(13) > 0.0f;
  return s;
}

/// The kind of light that each lane samples, and its number in that kind.
struct KindOfLight {
  Mask local, suns, sky;  ///< one of them, or none where no light can reach the point
  Int sun;                ///< number among the suns above the lane's surface
  Float probability;      ///< of the kind
  Float rest;             ///< of the random number, in [0, 1)
};

GATELIGHT_INLINE Mask is_above(const Receiver& r, const float* sun) {
  return ~(dot(r.n, {sun[0], sun[1], sun[2]}) > 0.0f);
}

/// All local lights together, each sun above the surface, and the sky have equal chances. `reached`: some
/// local light can reach the lane.
GATELIGHT_INLINE KindOfLight choose_kind(const LightArraysPtr& view, const Receiver& r, Mask reached,
                                         Float u_choice, Digits& digits) {
  Int suns(0u);
  for (uint32_t i = 0; i < view.sun_count; ++i)
    suns += words_of(is_above(r, view.suns + LightArraysPtr::kSunFloats * i)) & 1u;
  const Int one_local = words_of(reached) & 1u;
  Mask sky = no_lanes();
  if (view.always_sky) {
    sky = ~sky;
  } else if (view.sky == LightArraysPtr::Sky::constant) {
    sky = (one_local + suns) == 0u;
  }
  const Int parts = one_local + suns + (words_of(sky) & 1u);
  const Mask some = ~(parts == 0u);
  const Float count = to_float(select(some, parts, Int(1u)));
  const Float scaled = u_choice * count;
  const Int part = to_int(scaled);  // u < 1 - 2^-24, so it is below `count` except for a vast number of suns
  KindOfLight kind;
  kind.probability = 1.0f / count;
  kind.rest = digits.refill(scaled - to_float(part), count);
  kind.local = some & reached & (part == 0u);
  kind.sun = part - one_local;
  kind.sky = some & sky & (kind.sun == suns) & ~kind.local;
  kind.suns = some & ~kind.local & ~kind.sky;
  return kind;
}

/// The samples of all lanes.
struct LaneLights {
  Int state = state_of(LaneLight::none), light = Int(0u);
  Mask delta = no_lanes();
  Float3 wi, radiance = repeat(0.0f);
  Float distance = 1.0f, pdf = 0.0f, offset = 0.0f, cosine = 1.0f;
  Float2 point;

  /// `textured`: the state of lights that the kernels leave open.
  GATELIGHT_INLINE void take(const LanesOfLight& s, Int number, LaneLight textured) {
    wi = select(s.valid, s.wi, wi);
    radiance = select(s.valid, s.radiance, radiance);
    distance = select(s.valid, s.distance, distance);
    pdf = select(s.valid, s.pdf, pdf);
    offset = select(s.valid, s.offset, offset);
    cosine = select(s.valid, s.cosine, cosine);
    state = select(s.valid, select(s.textured, state_of(textured), state_of(LaneLight::done)), state);
    light = select(s.valid, number, light);
  }

  /// Emissive triangles and placed lights, by the light tree.
  GATELIGHT_INLINE void sample_local(const LightArraysPtr& view, const Receiver& r, const Weights& root,
                                     const KindOfLight& kind, Digits& digits) {
    const Float2 u = point;
    Int chosen(0u);
    Float probability = kind.probability;
    const Mask found =
        kind.local & ~descend(view, r, root, kind.local, kind.rest, digits, chosen, probability);
    const Mask triangle = found & (chosen < Int(view.triangle_count));
    if (any(triangle)) {
      const LanesOfLight s =
          sample_triangles(view, r.p, select(triangle, chosen, Int(0u)), probability, u, triangle);
      take(s, chosen, LaneLight::triangle);
      point.x = select(s.valid, s.point.x, point.x);
      point.y = select(s.valid, s.point.y, point.y);
    }
    const Mask placed = found & ~(chosen < Int(view.triangle_count));
    if (any(placed)) {
      const LanesOfLight s = sample_placed(view, r.p, select(placed, chosen - view.triangle_count, Int(0u)),
                                           probability, placed);
      take(s, chosen, LaneLight::profile);
      delta |= s.valid;
    }
  }

  GATELIGHT_INLINE void sample_suns(const LightArraysPtr& view, const Receiver& r, const KindOfLight& kind) {
    Int left = kind.sun;
    for (uint32_t i = 0; i < view.sun_count; ++i) {
      const float* const sun = view.suns + LightArraysPtr::kSunFloats * i;
      const Mask above = is_above(r, sun);
      const Mask taken = kind.suns & above & (left == 0u);
      left = left - (words_of(above) & 1u);
      wi = select(taken, {-sun[0], -sun[1], -sun[2]}, wi);
      radiance = select(taken, {sun[3], sun[4], sun[5]}, radiance);
      distance = select(taken, kInfinite, distance);
      pdf = select(taken, kind.probability, pdf);
      state = select(taken, state_of(LaneLight::done), state);
      light = select(taken, Int(view.triangle_count + view.placed_count + i), light);
      delta |= taken;
    }
  }

  GATELIGHT_INLINE void sample_sky(const LightArraysPtr& view, const Receiver& r, const KindOfLight& kind,
                                   Mask sheet, Float2 u) {
    const Mask to_sky = kind.sky;
    distance = select(to_sky, kInfinite, distance);
    light = select(to_sky, Int(view.triangle_count + view.placed_count + view.sun_count), light);
    if (view.sky != LightArraysPtr::Sky::constant) {
      pdf = select(to_sky, kind.probability, pdf);
      state = select(to_sky, state_of(LaneLight::environment), state);
      return;
    }
    Float3 d = Frame(r.n).to_world(sample_cosine_hemisphere(u.x, u.y));
    Float density = max(0.0f, dot(d, r.n)) * kInvPi;
    if (any(sheet)) {
      d = select(sheet, sample_uniform_sphere(u.x, u.y), d);
      density = select(sheet, 0.25f * kInvPi, density);
    }
    wi = select(to_sky, d, wi);
    radiance = select(to_sky, {view.sky_radiance[0], view.sky_radiance[1], view.sky_radiance[2]}, radiance);
    pdf = select(to_sky, kind.probability * density, pdf);
    state = select(to_sky & (density > 0.0f), state_of(LaneLight::done), state);
  }

  GATELIGHT_INLINE void put(ShadingBlock& block, int at) const {
    store(block.light_state + at, state);
    store(block.light + at, light);
    store(block.light_is_delta, at, delta);
    store(block.light_point[0] + at, point.x);
    store(block.light_point[1] + at, point.y);
    store(block.light_direction, at, wi);
    store(block.light_distance + at, distance);
    store(block.light_radiance, at, radiance);
    store(block.light_pdf + at, pdf);
    store(block.light_offset + at, offset);
    store(block.light_cosine + at, cosine);
  }
};

/// Lights::sample for the lanes from `at` on.
GATELIGHT_INLINE void sample_lights_at(ShadingBlock& block, const ShadingContext& context, int at) {
  const LightArraysPtr& view = context.lights;
  const LaneSampler sampler{block.sampler, load(block.sampler_key + at), load(block.sampler_index + at)};
  const Int dimensions = load(block.dimensions + at);
  const Float u_choice = sampler.get_1d(dimensions + 2u);
  const Float2 u = sampler.get_2d(dimensions + 3u);
  Digits digits{load(block.seed + at) ^ 0x7f4a7c15u};

  Receiver r;
  r.p = load(block.position, at);
  const Float transmission = max(load(block.transmission + at), load(block.diffuse_transmission + at));
  const Mask sheet = transmission * (1.0f - load(block.metallic + at)) > 0.0f;
  r.n = select_or_zero(~sheet, load(block.shading_normal, at));
  r.free = select_or_zero(sheet, Float(1.0f));

  Weights root;
  Mask reached = no_lanes();
  if (view.tree != nullptr) {
    root = weigh_root(r, view);
    reached = (root.c[0] + root.c[1]) + (root.c[2] + root.c[3]) > 0.0f;
  }
  const KindOfLight kind = choose_kind(view, r, reached, u_choice, digits);
  LaneLights lights;
  lights.wi = load(block.geometric_normal, at);
  lights.point = u;
  if (any(kind.local)) lights.sample_local(view, r, root, kind, digits);
  if (view.sun_count > 0) lights.sample_suns(view, r, kind);
  if (any(kind.sky)) lights.sample_sky(view, r, kind, sheet, u);
  lights.put(block, at);
}

}  // namespace

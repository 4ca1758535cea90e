#pragma once
// A path on its way through the scene, whoever adds up its light: a ray arrives (meet, or sky), a light is
// sampled (light_at), a direction is drawn (draw, survives), and the next ray leaves (advance). Next-event
// estimation and BSDF sampling are joined by multiple importance sampling (Veach 1997).

#include <cstdint>
#include <optional>

#include "renderer/film/camera_sample.h"
#include "renderer/transport/scattering.h"

namespace gatelight::renderer {

/// What paths walk through, and how the two techniques that find light are weighted.
struct Walk {
  const World& world;
  MisRule mis;
};

/// What shines at the end of a ray.
struct Emission {
  Color radiance{0.0f, 0.0f, 0.0f};
  float weight = 0.0f;  ///< of multiple importance sampling

  bool any() const { return (radiance > 0.0f).any(); }
};

/// A path at a surface.
struct Meeting {
  Ray& ray;  ///< that came here; the next one is written over it
  const Hit& hit;
  Surface surface;
  Vec3 wo;                         ///< unit, back along the ray
  float cone_width;                ///< metres
  Color passed{1.0f, 1.0f, 1.0f};  ///< share of the light that the medium before the surface lets through
  Emission emission;
  std::uint32_t dimensions = 0;      ///< the first of this vertex's, of the sampler
  std::optional<Bsdf> bsdf;          ///< none: the path ends here
  Vec3 light_normal = Vec3::Zero();  ///< as light sampling takes it
};

/// A light sample, as next-event estimation brings it to a surface.
struct LightAt {
  LightSample light;
  BsdfValue value;      ///< towards it
  float weight = 0.0f;  ///< of multiple importance sampling, over the density; 0: no light
};

enum class LightKinds : std::uint8_t {
  all,
  delta,   ///< those that no direction of a BSDF ever finds
  shapes,  ///< a sample of all, dropped where it is one of those
};

/// A direction that a path may go on in. Its weight is of power: radiance_scale is not in it.
struct Drawn : BsdfSample {
  bool through_pane = false;  ///< straight through a thin sheet: no scattering event
  float survival = 1.0f;      ///< of Russian roulette; the weight is divided by it

  /// What the weight would be of a part of the surface's lobes, deltas apart.
  Color weight_of(const Bsdf& part) const {
    return part.evaluate(wi).value / (pdf * survival * radiance_scale);
  }
};

struct Walker {
  RayCone cone;
  Color throughput{1.0f, 1.0f, 1.0f};  ///< of power
  Color absorption{0.0f, 0.0f, 0.0f};  ///< per metre, of the medium the ray travels in
  Departure departure;
  /// Product of BsdfSample::radiance_scale: not a loss of power. In double, since hundreds of media inside
  /// each other leave single precision before they come back to 1.
  double radiance_scale = 1.0;
  Sampler sampler;
  std::uint32_t index = 0;  ///< into the starts
  std::uint32_t seed = 0;
  std::int32_t depth = 0;      ///< scattering events so far
  std::int32_t surfaces = 0;   ///< met so far: the block of sampler dimensions
  bool emission_only = false;  ///< what comes next is looked at for its emission alone, through panes

  Walker() = default;
  Walker(const CameraSample& start, std::size_t which)
      : cone(start.camera_ray.cone),
        sampler(start.sampler),
        index(static_cast<std::uint32_t>(which)),
        seed(start.seed) {
    departure.position = start.camera_ray.ray.origin;
  }

  /// What radiance where the path is is worth at its start, losses of power apart.
  float scale() const { return static_cast<float>(radiance_scale); }
  /// The same with them.
  Color carried() const { return throughput * scale(); }

  /// The ray leaves the scene.
  Emission sky(const Walk& walk, const Vec3& direction) const {
    Emission sky{walk.world.environment.radiance(direction)};
    if (sky.any()) sky.weight = sky_weight(walk.world, walk.mis, departure, direction);
    return sky;
  }

  /// The ray arrives at a surface. From max_depth scattering events on there is still what the light samples
  /// of the vertex before saw behind panes: these are looked through for emission alone, since half of a
  /// weighted sum of both would be too dark.
  Meeting meet(const Walk& walk, Ray& ray, const Hit& hit, int max_depth) {
    const float cone_width = cone.width + cone.spread * hit.t;
    Meeting m{ray, hit, walk.world.surfaces.at(hit, ray.direction, cone_width, texture_level_number(seed)),
              -ray.direction, cone_width};
    if ((absorption > 0.0f).any()) {
      m.passed = (-absorption * hit.t).exp();
      throughput *= m.passed;
    }
    const Surface& surface = m.surface;
    m.emission.radiance = surface.emission;
    if (m.emission.any())
      m.emission.weight = emission_weight(walk.world, walk.mis, departure, hit, surface, ray.direction);
    if (depth >= max_depth) emission_only = true;
    const bool pane = surface.material.thin_walled && surface.material.transmission > 0.0f;
    if (surface.unlit || (emission_only && !pane)) return m;

    m.dimensions = dimension::kFirstVertex + dimension::kPerVertex * static_cast<std::uint32_t>(surfaces);
    m.bsdf.emplace(surface.material, surface.geometric_normal, surface.shading_normal, surface.coat_normal,
                   m.wo, surface.front);
    if (!m.bsdf->transmits()) m.light_normal = surface.shading_normal;
    return m;
  }

  /// Next-event estimation for `bsdf`: the surface's, or a part of it. Its shadow ray is shadow_ray()'s.
  LightAt light_at(const Walk& walk, const Meeting& m, const Bsdf& bsdf,
                   LightKinds kinds = LightKinds::all) const {
    LightAt at;
    const Lights& lights = walk.world.lights;
    if (emission_only || bsdf.is_delta() || lights.empty()) return at;
    const float choice = sampler.get_1d(m.dimensions + dimension::kLightChoice);
    const Vec2 point = sampler.get_2d(m.dimensions + dimension::kLightPoint);
    at.light = kinds == LightKinds::delta
                   ? lights.sample_delta(m.surface.position, m.light_normal, choice, point)
                   : lights.sample(m.surface.position, m.light_normal, choice, point);
    if (!(at.light.pdf > 0.0f) || (kinds == LightKinds::shapes && at.light.delta)) return at;
    at.value = bsdf.evaluate(at.light.wi);
    at.weight = (at.light.delta ? 1.0f : walk.mis.light_weight(at.light.pdf, at.value.pdf)) / at.light.pdf;
    return at;
  }

  /// A direction of `bsdf`: the surface's, or a part of it. None: the path ends.
  std::optional<Drawn> draw(const Meeting& m, const Bsdf& bsdf) {
    BsdfSample sample = bsdf.sample(sampler.get_1d(m.dimensions + dimension::kBsdfLobe),
                                    sampler.get_2d(m.dimensions + dimension::kBsdfDirection));
    if (!(sample.pdf > 0.0f) || !(sample.weight > 0.0f).any()) return {};
    const bool through_pane = sample.delta && sample.transmitted && m.surface.material.thin_walled;
    if (emission_only && !through_pane) return {};
    sample.weight /= sample.radiance_scale;
    throughput *= sample.weight;
    radiance_scale *= static_cast<double>(sample.radiance_scale);
    return Drawn{sample, through_pane};
  }

  /// Russian roulette: false where the path ends.
  bool survives_by(float survival, Drawn& drawn) {
    if (roulette_number(next_seed(seed)) >= survival) return false;
    drawn.survival = survival;
    drawn.weight /= survival;
    throughput /= survival;
    return true;
  }

  /// The same by what is left of the power, from min_depth scattering events on.
  bool survives(int min_depth, Drawn& drawn) {
    if (depth + (drawn.through_pane ? 0 : 1) < min_depth) return true;
    return survives_by(survival_probability(throughput), drawn);
  }

  /// The next ray leaves. False: the path ends, since it has passed too much without scattering.
  bool advance(const Walk& walk, const Meeting& m, const Drawn& drawn) {
    if (drawn.through_pane) {
      departure.travelled += m.hit.t;
      departure.panes += 1;
    } else {
      depth += 1;
      departure = {m.surface.position, m.light_normal, 0.0f, drawn.pdf, drawn.delta};
      if (drawn.transmitted && !m.surface.material.thin_walled) {
        absorption = m.surface.front ? absorption_of(walk.world.surfaces.material(m.hit.instance))
                                     : Color(0.0f, 0.0f, 0.0f);
      }
    }
    surfaces += 1;
    if (surfaces > depth + kMaxPassed) return false;
    seed = next_seed(seed);
    m.ray = {m.surface.spawn(drawn.wi), scene::kInfinity, drawn.wi, seed};
    cone.width = m.cone_width;
    if (!drawn.through_pane) cone.spread += drawn.spread * kDiffuseSpread;
    return true;
  }
};

}  // namespace gatelight::renderer

#pragma once
// The walk of a path through the scene, which all path-tracing integrators share: a ray arrives
// (intersect, or sky), a light is sampled (sample_light), a direction is sampled (sample_bsdf, survives), and
// the next ray leaves (advance). Next-event estimation and BSDF sampling are joined by multiple importance
// sampling (Veach 1997).

#include <cstdint>
#include <optional>
#include <utility>

#include "renderer/film/camera_sample.h"
#include "renderer/sampling/wavelength.h"
#include "renderer/transport/scattering.h"

namespace gatelight::renderer {

/// The scene of a path and its rules.
struct PathContext {
  const World& world;
  MisRule mis;
  int max_transmission_depth;  ///< a path ends after that many scattering events to the other side
  bool has_rules;              ///< World::light_rules has any
  Shading shading;

  PathContext(const World& where, const MisRule& rule, int max_transmissions)
      : world(where),
        // Bounces do not know the blockers of lights.
        mis(world.masks.any_blockers() && rule.direct == DirectLight::mis
                ? MisRule{DirectLight::nee, rule.heuristic}
                : rule),
        max_transmission_depth(max_transmissions),
        has_rules(!world.light_rules.empty()),
        shading(world.lights, world.light_arrays, world.kernels, world.requirements.sheen, mis.direct,
                mis.heuristic) {}
};

/// Paths that wait at surfaces until a block is full.
struct PathBlock : SurfaceBlock {
  std::uint32_t path[ShadingBlock::kWidth];  ///< the caller's number
  float cone_width[ShadingBlock::kWidth];    ///< metres
  bool front[ShadingBlock::kWidth];          ///< Surface::front
  /// Where a path can enter or leave a medium; only in blocks for the scalar code.
  struct Crossing {
    std::uint32_t volume = scene::kNoVolume;  ///< SurfaceInteraction::volume, and so on
    bool unrefracted = false;
    bool same_medium = false;
  };
  std::vector<Crossing> crossing;

  /// For surfaces that the kernels do not support.
  void make_scalar() {
    scalar.resize(ShadingBlock::kWidth);
    crossing.resize(ShadingBlock::kWidth);
  }
};

/// Emission that a ray finds.
struct Emission {
  Color radiance{0.0f, 0.0f, 0.0f};
  float weight = 0.0f;  ///< MIS weight

  bool any() const { return (radiance > 0.0f).any(); }
};

/// A path at a surface.
struct SurfaceInteraction {
  const Hit& hit;
  Surface surface;
  Vec3 wo;           ///< unit, back along the ray
  float cone_width;  ///< metres
  /// Transmittance of the medium before the surface, times the colour of a wavelength that is chosen here.
  Color passed{1.0f, 1.0f, 1.0f};
  bool unrefracted = false;                 ///< glass with an inside that does not refract this ray
  std::uint32_t volume = scene::kNoVolume;  ///< of World::media, where light can enter or leave one
  bool same_medium = false;                 ///< a stronger volume is on both sides: a clear pane
  Emission emission;
  bool ends = false;             ///< the path ends here
  std::uint32_t dimensions = 0;  ///< first sampler dimension of this vertex

  /// `u_level` in [0, 1) chooses between mip levels.
  SurfaceInteraction(const World& world, const Ray& ray, const Hit& where, float width, float u_level)
      : hit(where),
        surface(world.surfaces.at(hit, ray.direction, width, u_level)),
        wo(-ray.direction),
        cone_width(width) {}
};

/// A sampled direction. Its weight leaves out radiance_scale.
struct DirectionSample : BsdfSample {
  bool through_pane = false;                   ///< unrefracted through a thin sheet: no scattering event
  scene::RayKinds kind = scene::kDiffuseRays;  ///< of the lobe; any bounce without RayMasks::by_lobe
  float survival = 1.0f;  ///< probability in Russian roulette; the weight is divided by it
};

/// The shadow ray of a lane's light sample.
inline Ray shadow_ray_at(const ShadingBlock& p, int lane) {
  return {.origin = lane_vector(p.shadow_origin, lane),
          .t_max = p.shadow_length[lane],
          .direction = lane_vector(p.light_direction, lane),
          .seed = p.shadow_seed[lane],
          .time = p.time[lane],
          .mask = ray_mask(scene::kShadowRays)};
}

/// Whether a lane's light sample lights the surface from behind.
inline bool light_is_behind(const ShadingBlock& p, int lane) {
  return lane_vector(p.light_direction, lane).dot(lane_vector(p.geometric_normal, lane)) < 0.0f;
}

struct PathState {
  RayCone cone;
  Color throughput{1.0f, 1.0f, 1.0f};        ///< without radiance_scale
  const ScatteringMedium* inside = nullptr;  ///< what the ray travels in; null: nothing
  std::uint32_t body = kNoInstance;          ///< a surface of the body that it travels in
  std::uint32_t mask = ~0u;                  ///< Ray::mask of its ray
  float reach = kInfinity;                   ///< metres that a camera's ray may still go
  MediumStack interior;                      ///< the volumes of World::media that it travels in
  PreviousVertex previous;
  /// Product of BsdfSample::radiance_scale, which is no loss of power. In double: with hundreds of nested
  /// media it leaves the range of single precision before it returns to 1.
  double radiance_scale = 1.0;
  Sampler sampler;
  std::uint32_t index = 0;  ///< into the starts
  float wavelength = 0.0f;  ///< nanometres; 0: all, until a surface disperses them
  /// The colour of the wavelength. Roulette and guides leave it out: it is one on average.
  Color spectrum{1.0f, 1.0f, 1.0f};
  float contribution_threshold = 0.0f;  ///< CameraSample::contribution_threshold
  std::uint32_t seed = 0;
  std::int32_t depth = 0;          ///< scattering events so far
  std::int32_t transmissions = 0;  ///< scattering events to the other side so far
  std::int32_t surfaces = 0;       ///< hit so far: selects the block of sampler dimensions
  bool sees_through = true;        ///< all surfaces so far were mirrors or clear
  bool emission_only = false;      ///< from here on the path only passes panes and counts emission

  PathState() = default;
  PathState(const World& world, const CameraSample& start, std::size_t which)
      : cone(start.camera_ray.cone),
        mask(start.camera_ray.ray.mask),
        reach(start.camera_ray.ray.t_max),
        interior(start.start.volumes),
        sampler(start.sampler),
        index(static_cast<std::uint32_t>(which)),
        contribution_threshold(start.contribution_threshold),
        seed(start.seed) {
    previous.position = start.camera_ray.ray.origin;
    previous.travelled = start.camera_ray.begin;
    const Medium& around = world.media.of(interior.strongest());
    body = start.start.body != kNoInstance ? start.start.body : around.instance;
    inside = start.start.body != kNoInstance ? world.media.inside(world.coverage.material_of(body))
                                             : around.inside;
  }

  /// Factor from radiance at the path's position to radiance at its start, without losses of power.
  float scale() const { return static_cast<float>(radiance_scale); }
  /// The same factor with the losses.
  Color carried() const { return throughput * spectrum * scale(); }

  /// Whether the path has met neither a surface nor a scattering event of a medium.
  bool is_unscattered() const { return surfaces == 0 && depth == 0; }

  /// Whether the hit is ignored: the camera looks through a shadow catcher.
  bool looks_through(const PathContext& context, const Hit& hit) const {
    return surfaces == 0 && context.world.catches(hit.instance);
  }
  /// Whether the camera sees a hole there.
  bool is_held_out(const PathContext& context, const Hit& hit) const {
    return depth == 0 && context.world.holds_out(hit.instance);
  }

  /// The share of the background in the sample, for a ray that leaves the scene: above zero only without a
  /// scattering event.
  float background() const { return depth == 0 ? luminance(carried()) : 0.0f; }

  /// The emission of the sky for a ray that leaves the scene.
  Emission sky(const PathContext& context, const Vec3& direction) const {
    if (context.world.separate_background && depth == 0) return {};
    if (context.has_rules && !sees(context.world.light_rules.of_environment())) return {};
    Emission sky{context.world.environment.radiance(direction)};
    if (sky.any()) sky.weight = sky_weight(context.world, context.mis, previous, direction);
    return sky;
  }

  /// Handles the ray's arrival at a surface. After max_depth scattering events the path still passes panes
  /// and counts emission behind them: the light samples of the vertex before include it, and one part of the
  /// MIS sum by itself would be too dark.
  SurfaceInteraction intersect(const PathContext& context, const Ray& ray, const Hit& hit, int max_depth) {
    SurfaceInteraction m(context.world, ray, hit, cone.width + cone.spread * hit.t,
                         texture_level_number(seed));
    if (inside && !inside->scatters) {
      m.passed = (-inside->extinction * hit.t).exp();
      throughput *= m.passed;
    }
    Surface& surface = m.surface;
    // Rays that light samples compete with take the same way as shadow rays.
    if (!previous.delta && context.world.coverage.is_unrefracted_glass(hit.instance)) {
      m.unrefracted = true;
      surface.shading_normal = surface.geometric_normal;
    }
    if (!context.world.media.empty()) intersect_volume(context.world.media, m);
    if (m.unrefracted) remove_refraction(surface.material);
    if (surface.material.dispersion > 0.0f && !m.unrefracted) disperse(m);
    m.emission.radiance = surface.emission;
    if (context.has_rules && m.emission.any() && !surface.unlit &&
        !sees(context.world.light_rules.of_instance(hit.instance)))
      m.emission.radiance.setZero();
    if (m.emission.any())
      m.emission.weight = emission_weight(context.world, context.mis, previous, hit, surface, ray.direction);
    if (depth >= max_depth) emission_only = true;
    const bool pane = surface.material.thin_walled && surface.material.transmission > 0.0f;
    m.ends = surface.unlit || (emission_only && !pane);
    m.dimensions = dimension::kFirstVertex + dimension::kPerVertex * static_cast<std::uint32_t>(surfaces);
    return m;
  }

  /// Whether the kernels can shade the surface: SurfaceBlock::scalar is empty then.
  bool kernels_shade(const SurfaceInteraction& m) const {
    return !emission_only && !m.unrefracted && !m.same_medium && renderer::kernels_shade(m.surface);
  }

  /// Whether the path's ray finds the light of an emitter in its way.
  bool sees(const LightRule& emitter) const {
    return (mask & ray_mask(emitter.rays)) != 0 && (depth == 0 || emitter.lights(previous.instance));
  }

  /// Adds the path to a block that is not full. `which` is the caller's number of the path.
  void enqueue(const PathContext& context, const SurfaceInteraction& m, std::uint32_t which, int min_depth,
               PathBlock& block) const {
    const int lane = block.points.count++;
    block.path[lane] = which;
    block.cone_width[lane] = m.cone_width;
    block.front[lane] = m.surface.front;
    ShadingBlock& points = block.points;
    points.sampler = sampler.kind();
    points.sampler_key[lane] = sampler.key();
    points.sampler_index[lane] = sampler.index();
    points.dimensions[lane] = m.dimensions;
    points.seed[lane] = seed;
    points.time[lane] = m.hit.time;
    points.events_before_roulette[lane] = static_cast<std::uint32_t>(min_depth - depth);
    for (int c = 0; c < 3; ++c) points.throughput[c][lane] = throughput[c];
    if (block.scalar.empty()) return put_surface(points, lane, m.surface, m.wo);
    put_geometry(points, lane, m.surface, m.wo);
    ScalarLane& scalar = block.scalar[static_cast<std::size_t>(lane)];
    put_lobes(scalar, m.surface, m.wo);
    scalar.only_panes = emission_only;
    scalar.front_lights = refracts_without_mis(context, m.surface);
    block.crossing[static_cast<std::size_t>(lane)] = {m.volume, m.unrefracted, m.same_medium};
  }

  /// The shadow ray of a lane's light sample, and the transmittance of the medium in which it starts: zero
  /// where the light does not concern the surface. The transmittance is one where the ray may leave the
  /// medium before it arrives: in fog, and where shadow rays pass glass with an inside. Then Ray::inside
  /// makes the ray apply it.
  std::pair<Ray, Color> shadow_ray(const PathContext& context, const PathBlock& block, int lane,
                                   std::uint32_t instance) const {
    Ray ray = shadow_ray_at(block.points, lane);
    if (context.has_rules) [[unlikely]] {
      const LightRule& rule = context.world.light_rules.of_light(block.points.light[lane]);
      if (!rule.lights(instance) || (rule.rays & scene::kBounceRays) == 0) return {ray, Color::Zero()};
      ray.mask = rule.shadow_mask;
    }
    const ScatteringMedium* const medium = medium_towards_light(context, block, lane, instance);
    if (!medium) return {ray, Color::Ones()};
    if (medium->box || context.world.coverage.unrefracted_glass()) {
      if (medium->scatters) ray.inside = medium;
      return {ray, Color::Ones()};
    }
    if (!(ray.t_max < kInfinity)) return {ray, Color::Ones()};
    return {ray, (-medium->extinction * ray.t_max).exp()};
  }

  /// Russian roulette of a light sample whose contribution has this largest channel: the factor to its
  /// contribution, 0 where its shadow ray is not traced. `least`: contributions that are not smaller are
  /// always traced.
  float shadow_weight(float contribution, float least) const {
    if (!(contribution > 0.0f)) return 0.0f;
    if (!(contribution < least)) return 1.0f;
    return shadow_roulette_number(seed) * least < contribution ? least / contribution : 0.0f;
  }

  /// Makes the next ray of a lane that is shaded, from its hit. False: the path ends, because it went through
  /// too many surfaces.
  bool advance(const PathContext& context, const PathBlock& block, int lane, const DirectionSample& sampled,
               const Hit& hit, Ray& ray) {
    const ShadingBlock& p = block.points;
    throughput *= sampled.weight;
    const bool without_mis = !block.scalar.empty() && leave(context, block, lane, sampled, hit.instance);
    if (sampled.through_pane) {
      reach -= hit.t;
      previous.travelled += hit.t;
      previous.panes += 1;
      previous.without_mis |= without_mis;
    } else {
      depth += 1;
      transmissions += sampled.transmitted ? 1 : 0;
      previous = {lane_vector(p.position, lane), light_normal(p, lane), 0.0f, sampled.pdf,
                  sampled.delta || without_mis};
      previous.instance = hit.instance;
      reach = kInfinity;
      mask = ray_mask(sampled.kind);
    }
    surfaces += 1;
    if (surfaces > depth + kMaxPassed || transmissions > context.max_transmission_depth) return false;
    seed = next_seed(seed);
    ray = {lane_vector(p.next_origin, lane), reach, sampled.wi, seed, hit.time, mask};
    cone.width = block.cone_width[lane];
    if (!sampled.through_pane) cone.spread += sampled.spread * kDiffuseSpread;
    return true;
  }

 private:
  /// Whether only bounces find light that the surface refracts. Where shadow rays pass glass unrefracted,
  /// they would leave its inside unrefracted too.
  static bool refracts_without_mis(const PathContext& context, const Surface& surface) {
    return context.world.coverage.unrefracted_glass() && !surface.material.thin_walled &&
           surface.material.transmission > 0.0f;
  }

  /// Handles a surface in a scene of nested volumes. The boundary of a volume exists if the volume is the
  /// strongest of those around, and refracts light by its index over that of the strongest of the others.
  [[gnu::noinline, gnu::cold]] void intersect_volume(const Media& media, SurfaceInteraction& m) {
    SurfaceMaterial& material = m.surface.material;
    if (material.thin_walled || !(material.transmission > 0.0f || material.diffuse_transmission > 0.0f))
      return;
    m.volume = media.volume_of(m.hit.instance);
    if (!media.is_there(m.volume, interior)) {
      m.same_medium = make_index_matched(material, boundary_number(seed));
      return;
    }
    const Medium& outside = media.beyond(m.volume, interior);
    if (m.unrefracted || outside.dispersion == 0.0f) {
      if (!m.unrefracted && material.dispersion > 0.0f) disperse(m);
      material.ior /= outside.ior;
    } else {
      choose_wavelength(m);
      if (material.dispersion > 0.0f) disperse(m);
      material.ior /= dispersed_ior(outside.ior, outside.dispersion, wavelength);
    }
    material.dispersion = 0.0f;
  }

  /// The medium on the side of a lane's surface where its light sample is.
  const ScatteringMedium* medium_towards_light(const PathContext& context, const PathBlock& block, int lane,
                                               std::uint32_t instance) const {
    if (block.scalar.empty() || !changes_medium(block, lane) || !light_is_behind(block.points, lane))
      return inside;
    MediumStack there = interior;
    return cross(context.world.media, there, block.crossing[static_cast<std::size_t>(lane)].volume,
                 block.front[lane], instance, context.world.coverage.material_of(instance))
        .medium;
  }

  /// Whether a path that passes a lane's surface enters or leaves a medium there.
  static bool changes_medium(const PathBlock& block, int lane) {
    const PathBlock::Crossing& m = block.crossing[static_cast<std::size_t>(lane)];
    return m.unrefracted || m.same_medium || !block.scalar[static_cast<std::size_t>(lane)].thin_walled;
  }

  /// The path leaves a surface of the scalar code, perhaps into another medium. True: light samples do not
  /// compete with the light that the next ray finds.
  bool leave(const PathContext& context, const PathBlock& block, int lane, const DirectionSample& sampled,
             std::uint32_t instance) {
    const ScalarLane& scalar = block.scalar[static_cast<std::size_t>(lane)];
    const PathBlock::Crossing& m = block.crossing[static_cast<std::size_t>(lane)];
    radiance_scale *= static_cast<double>(scalar.radiance_scale);
    if (sampled.transmitted && changes_medium(block, lane)) {
      const InsideOf next = cross(context.world.media, interior, m.volume, block.front[lane], instance,
                                  context.world.coverage.material_of(instance));
      inside = next.medium;
      body = next.instance;
    }
    return (m.same_medium && !m.unrefracted) || (sampled.transmitted && scalar.front_lights);
  }

  /// Chooses the path's wavelength, unless it has one.
  void choose_wavelength(SurfaceInteraction& m) {
    if (wavelength != 0.0f) return;
    const Wavelength chosen = sample_wavelength(sampler.get_1d(dimension::kWavelength));
    wavelength = chosen.nm;
    m.passed *= chosen.color;
    spectrum = chosen.color;
  }

  [[gnu::noinline, gnu::cold]] void disperse(SurfaceInteraction& m) {
    choose_wavelength(m);
    SurfaceMaterial& material = m.surface.material;
    material.ior = dispersed_ior(material.ior, material.dispersion, wavelength);
  }
};

/// The sampled direction of a lane whose path goes on.
inline DirectionSample direction_sample_at(const SurfaceBlock& block, int lane) {
  const ShadingBlock& p = block.points;
  DirectionSample sampled;
  sampled.wi = lane_vector(p.wi, lane);
  sampled.weight = lane_color(p.weight, lane);
  sampled.pdf = p.pdf[lane];
  sampled.delta = p.is_delta[lane] != 0;
  sampled.transmitted = p.transmitted[lane] != 0;
  sampled.spread = p.spread[lane];
  const bool thin = block.scalar.empty() || block.scalar[static_cast<std::size_t>(lane)].thin_walled;
  sampled.through_pane = sampled.delta && sampled.transmitted && thin;
  sampled.survival = p.survival[lane];
  return sampled;
}

}  // namespace gatelight::renderer

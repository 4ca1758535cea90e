#include "renderer/transport/shadow_catcher.h"

#include <algorithm>

#include "base/parallel/loops.h"
#include "renderer/film/film_samples.h"
#include "renderer/film/tiles.h"
#include "renderer/sampling/warp.h"
#include "renderer/transport/scattering.h"

namespace gatelight::renderer {
namespace {

/// A part of the unshadowed light of a pixel. Its shadow ray decides whether it arrives.
struct Pending {
  std::size_t pixel;
  float light;
};

struct Sums {
  double unshadowed = 0.0, lit = 0.0;
  int caught = 0;
};

class Catcher {
 public:
  Catcher(const World& world, std::vector<Sums>& sums) : world_(world), sums_(sums) {}

  void add(std::size_t pixel, const CameraSample& sample, const Ray& ray, const Hit& hit) {
    sums_[pixel].caught += 1;
    const RayCone& cone = sample.camera_ray.cone;
    const Surface surface = world_.surfaces.at(hit, ray.direction, cone.width + cone.spread * hit.t, 0.5f);
    const Vec3& n = surface.shading_normal;
    const Sampler& sampler = sample.sampler;
    const std::uint32_t first = dimension::kFirstVertex;
    const LightSample light =
        world_.lights.sample(surface.position, n, sampler.get_1d(first + dimension::kLightChoice),
                             sampler.get_2d(first + dimension::kLightPoint), hit.time);
    const float cosine = n.dot(light.wi);
    const LightRules& rules = world_.light_rules;
    const auto catches = [&](const LightRule& rule) {
      return (rule.rays & scene::kDiffuseRays) != 0 && rule.lights(hit.instance);
    };
    if (light.pdf > 0.0f && cosine > 0.0f && (rules.empty() || catches(rules.of_light(light.light)))) {
      const bool sky = !light.delta && light.distance == kInfinity;
      const float weight = sky ? light.pdf / (light.pdf + cosine * kInvPi) : 1.0f;
      Ray shadow = shadow_ray(surface, light, sample.seed, hit.time);
      if (!rules.empty()) shadow.mask = rules.of_light(light.light).shadow_mask;
      trace(pixel, shadow, kInvPi * cosine * weight * luminance(light.radiance) / light.pdf);
    }
    // Light samples may leave out the sky, so a bounce samples it too.
    if (!rules.empty() && !catches(rules.of_environment())) return;
    const Vec3 local = sample_cosine_hemisphere(sampler.get_2d(first + dimension::kBsdfDirection));
    const Vec3 wi = Basis(n).to_world(local);
    const float density = kInvPi * std::max(local.z(), 0.0f);
    if (!(density > 0.0f)) return;
    Ray open{surface.spawn(wi),
             kInfinity,
             wi,
             hash(sample.seed ^ 0x63617463u),
             hit.time,
             rules.empty() ? ray_mask(scene::kShadowRays) : rules.of_environment().shadow_mask};
    trace(pixel, open,
          luminance(world_.environment.radiance(wi)) * density /
              (density + world_.lights.pdf_environment(surface.position, n, wi)));
  }

  void finish() {
    std::vector<Color> transmittance(rays_.size()), by_catchers(rays_.size());
    world_.accel.transmittance(rays_, transmittance);
    for (Ray& ray : rays_) ray.mask = kCatcherMask;
    world_.accel.transmittance(rays_, by_catchers);
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      Sums& sums = sums_[pending_[i].pixel];
      const auto light = static_cast<double>(pending_[i].light);
      sums.unshadowed += light * static_cast<double>(luminance(by_catchers[i]));
      sums.lit += light * static_cast<double>(luminance(transmittance[i]));
    }
    rays_.clear();
    pending_.clear();
  }

 private:
  void trace(std::size_t pixel, const Ray& ray, float light) {
    if (!(light > 0.0f)) return;
    rays_.push_back(ray);
    pending_.push_back({pixel, light});
  }

  const World& world_;
  std::vector<Sums>& sums_;
  std::vector<Ray> rays_;
  std::vector<Pending> pending_;
};

}  // namespace

std::vector<float> catch_shadows(const World& world, const Camera& camera, const FilterSampler& filter,
                                 const RenderOptions& options, const PixelRect& rect, int samples) {
  std::vector<float> alpha(rect.index(rect.x0, rect.y1), 0.0f);
  const TileGrid tiles(rect);
  RenderOptions own = options;
  own.seed = hash(options.seed ^ hash(0x73686164u));
  for_each(static_cast<std::size_t>(tiles.count()), [&](std::size_t tile) {
    std::vector<Pixel> pixels;
    tiles.pixels(static_cast<int>(tile), pixels);
    std::vector<Sums> sums(pixels.size());
    std::vector<CameraSample> starts(pixels.size());
    std::vector<Ray> rays(pixels.size());
    std::vector<Hit> hits(pixels.size());
    Catcher catcher(world, sums);
    for (int s = 0; s < samples; ++s) {
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        starts[i] = make_camera_sample({pixels[i], static_cast<std::uint32_t>(s)}, own, camera, filter);
        rays[i] = starts[i].ray();
      }
      world.accel.intersect(rays, hits, true);
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (hits[i] && world.catches(hits[i].instance)) catcher.add(i, starts[i], rays[i], hits[i]);
      }
      catcher.finish();
    }
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (!(sums[i].unshadowed > 0.0)) continue;
      const double shadow = std::clamp(1.0 - sums[i].lit / sums[i].unshadowed, 0.0, 1.0);
      alpha[rect.index(pixels[i].x, pixels[i].y)] = static_cast<float>(shadow * sums[i].caught / samples);
    }
  });
  return alpha;
}

}  // namespace gatelight::renderer

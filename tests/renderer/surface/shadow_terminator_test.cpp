// Coarse round meshes: light that the round surface sees is not hidden by the flat triangles.

#include "renderer/surface/shadow_terminator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "renderer/sampling/sampler.h"
#include "renderer/sampling/warp.h"
#include "renderer/surface/accel.h"
#include "renderer/surface/surface.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;

struct World {
  explicit World(const scene::Scene& s)
      : textures(s), coverage(s, textures), surfaces(s, textures), accel(s, coverage, {}) {}

  Hit hit(const Ray& ray) const {
    Hit hit;
    accel.intersect({&ray, 1}, {&hit, 1}, false);
    return hit;
  }
  bool blocked(const Ray& ray) const {
    Color open;
    accel.transmittance({&ray, 1}, {&open, 1});
    return !(open.x() > 0.0f);
  }

  Textures textures;
  Coverage coverage;
  Surfaces surfaces;
  Accel accel;
};

Vec2 random_2d(std::uint32_t i, std::uint32_t dimension) {
  return Sampler(SamplerKind::independent, 1, 0, 0, i).get_2d(dimension);
}

/// The share of light from above the smooth horizon, weighted by its cosine, that points of a ball lose.
double lost_light(int segments) {
  SceneBuilder builder;
  builder.sphere(builder.material(SceneBuilder::lambert(Color::Ones())), Vec3(0, 0, 0), 1.0f, segments, true);
  const World world(builder.scene());
  int lost = 0, all = 0;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const Vec3 from = sample_uniform_sphere(random_2d(i, 0));
    Ray ray;
    ray.origin = 3.0f * from;
    ray.direction = (0.7f * sample_uniform_sphere(random_2d(i, 2)) - ray.origin).normalized();
    const Hit hit = world.hit(ray);
    if (!hit) continue;
    const Surface surface = world.surfaces.at(hit, ray.direction, 0.0f, 0.5f);
    const Vec3 wi = Basis(surface.smooth_normal).to_world(sample_cosine_hemisphere(random_2d(i, 4)));
    all += 1;
    if (!(wi.dot(surface.geometric_normal) > 0.0f)) {
      lost += 1;
    } else {
      lost += world.blocked({surface.spawn(wi), scene::kInfinity, wi, i}) ? 1 : 0;
    }
  }
  return lost / static_cast<double>(all);
}

TEST(ShadowTerminator, ABallLosesNoLightToItsTriangles) {
  for (const int segments : {12, 24, 48}) {
    std::printf("%d %.5f\n", segments, lost_light(segments));
  }
}

}  // namespace
}  // namespace gatelight::renderer

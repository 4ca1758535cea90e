// Lamps of any size, near and far.

#include <gtest/gtest.h>

#include "renderer/transport/scattering.h"
#include "renderer/transport/world.h"
#include "tests/extremes/pictures.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using namespace testing;

Vec3 random_unit(Random& random) {
  return sample_uniform_sphere({random.uniform_float(), random.uniform_float()});
}

/// A square lamp of this size about `centre` that emits on both sides, and at `height` before it a receiver
/// whose side is a fiftieth of the height.
struct LampAndReceiver {
  SceneBuilder builder;
  Vec3 normal;  ///< of both

  LampAndReceiver(float size, float height, const Vec3& centre, const Vec3& n, float receiver_share = 0.02f)
      : normal(n) {
    const Basis basis(n);
    scene::Material shine = SceneBuilder::lambert(Color::Zero(), Color::Ones());
    shine.double_sided = true;
    const Vec3 t = basis.tangent * size;
    const Vec3 b = basis.bitangent * size;
    builder.quad(builder.material(shine), centre - 0.5f * t - 0.5f * b, t, b);
    const float side = receiver_share * height;
    const Vec3 at = centre + n * height - 0.5f * side * (basis.tangent + basis.bitangent);
    builder.quad(builder.material(SceneBuilder::lambert(Color::Constant(0.5f))), at, side * basis.bitangent,
                 side * basis.tangent);
  }
};

/// Share of the light samples at the receiver that are not shadowed: 1 with nothing before the lamp.
double unshadowed(LampAndReceiver& made, Random& random, int samples) {
  const scene::Scene& s = made.builder.scene();
  const World world(s);
  std::vector<Ray> rays;
  for (int i = 0; i < samples; ++i) {
    const Hit hit{1.0f, 0.5f * random.uniform_float(), 0.5f * random.uniform_float(), 1,
                  static_cast<std::uint32_t>(i & 1)};
    const Surface surface = world.surfaces.at(hit, made.normal, 0.0f, 0.0f);
    const LightSample light =
        world.lights.sample(surface.position, surface.shading_normal, random.uniform_float(),
                            {random.uniform_float(), random.uniform_float()});
    if (light.pdf > 0.0f && light.wi.dot(surface.shading_normal) > 0.0f)
      rays.push_back(shadow_ray(surface, light, 0));
  }
  std::vector<Color> passed(rays.size());
  world.accel.transmittance(rays, passed);
  double sum = 0.0;
  for (const Color& c : passed) sum += static_cast<double>(c.x());
  return rays.empty() ? 0.0 : sum / static_cast<double>(rays.size());
}

TEST(Lamps, NoLampShadowsItself) {
  Random random(1);
  for (const float size : {1e-3f, 1.0f, 1e3f, 1e6f}) {
    for (const float part : {1e-4f, 1e-3f, 1e-2f, 1.0f, 1e2f, 1e4f}) {
      for (int turn = 0; turn < 8; ++turn) {
        const Vec3 n = random_unit(random);
        LampAndReceiver made(size, part * size, 0.3f * size * random_unit(random), n);
        EXPECT_EQ(unshadowed(made, random, 400), 1.0) << size << " " << part;
      }
    }
  }
}

TEST(Lamps, ASheetCloseToAFarLampShadowsIt) {
  // The lamp is a metre wide and 20 m above the receiver. The sheet before it is a 100 000th of the way from
  // it.
  Random random(2);
  for (int turn = 0; turn < 8; ++turn) {
    const Vec3 n = random_unit(random);
    LampAndReceiver made(1.0f, 20.0f, Vec3::Zero(), n);
    const Basis basis(n);
    const int sheet = made.builder.material(SceneBuilder::lambert(Color::Ones()));
    made.builder.quad(sheet, 2e-4f * n - 2.0f * basis.tangent - 2.0f * basis.bitangent, 4.0f * basis.tangent,
                      4.0f * basis.bitangent);
    EXPECT_EQ(unshadowed(made, random, 400), 0.0);
  }
}

}  // namespace
}  // namespace gatelight::renderer

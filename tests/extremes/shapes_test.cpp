// Lamps of any size, near and far, and badly shaped meshes: all sizes of triangles, slivers, degenerate and
// redundant faces.

#include <gtest/gtest.h>

#include "renderer/transport/scattering.h"
#include "renderer/transport/world.h"
#include "tests/extremes/pictures.h"
#include "tests/support/light_scenes.h"
#include "tests/support/room.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using namespace testing;

Vec3 random_direction(Random& random) {
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
        const Vec3 n = random_direction(random);
        LampAndReceiver made(size, part * size, 0.3f * size * random_direction(random), n);
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
    const Vec3 n = random_direction(random);
    LampAndReceiver made(1.0f, 20.0f, Vec3::Zero(), n);
    const Basis basis(n);
    const int sheet = made.builder.material(SceneBuilder::lambert(Color::Ones()));
    made.builder.quad(sheet, 2e-4f * n - 2.0f * basis.tangent - 2.0f * basis.bitangent, 4.0f * basis.tangent,
                      4.0f * basis.bitangent);
    EXPECT_EQ(unshadowed(made, random, 400), 0.0);
  }
}

RenderOptions mesh_picture(Integrator integrator) {
  RenderOptions options = room_picture(integrator, integrator == Integrator::nao ? 96 : 16);
  options.width = 48;
  options.height = 32;
  options.spp = 16;
  return options;
}

/// One mesh in a plane: triangles whose sides are powers of ten, each three sides from the origin.
constexpr int kMin = -6;
constexpr int kGreatest = 3;
std::array<Vec3, 3> triangle_of(int exponent) {
  const float side = std::pow(10.0f, static_cast<float>(exponent));
  return {Vec3(3 * side, 0, 0), Vec3(3 * side, 0, -1.4f * side), Vec3(4.4f * side, 0, 0)};
}

SceneBuilder many_sizes(const Color& emission) {
  SceneBuilder builder;
  PaddedVector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (int e = kMin; e <= kGreatest; ++e) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (const Vec3& p : triangle_of(e)) positions.push_back(p);
    triangles.push_back({first, first + 2, first + 1});
  }
  scene::Material m = SceneBuilder::lambert(Color::Constant(0.5f), emission);
  m.double_sided = true;
  builder.mesh(builder.material(m), positions, triangles);
  return builder;
}

TEST(Meshes, TrianglesOfAllSizesAreHitInPlaceWithoutSelfIntersection) {
  SceneBuilder builder = many_sizes(Color::Zero());
  const World world(builder.scene());
  Random random(1);
  int missed = 0, self = 0;
  for (int e = kMin; e <= kGreatest; ++e) {
    const auto corners = triangle_of(e);
    const float side = (corners[2] - corners[0]).norm();
    for (int i = 0; i < 1000; ++i) {
      const Vec2 b = 0.98f * sample_uniform_triangle({random.uniform_float(), random.uniform_float()}) +
                     Vec2(0.005f, 0.005f);
      const Vec3 at = corners[0] + b.x() * (corners[1] - corners[0]) + b.y() * (corners[2] - corners[0]);
      Vec3 from = random_direction(random);
      from.y() = std::abs(from.y()) + 0.2f;
      Ray ray;
      ray.origin = at + side * from;
      ray.direction = -from.normalized();
      Hit hit;
      world.accel.intersect({&ray, 1}, {&hit, 1}, false);
      if (!hit || hit.primitive != static_cast<std::uint32_t>(e - kMin)) {
        ++missed;
        continue;
      }
      const Surface s = world.surfaces.at(hit, ray.direction, 0.0f, 0.0f);
      EXPECT_LT((s.position - at).norm(), 1e-5f * side);
      EXPECT_NEAR(s.geometric_normal.y(), 1.0f, 1e-6f);
      Ray next;
      next.direction =
          Basis(s.geometric_normal)
              .to_world(sample_cosine_hemisphere({random.uniform_float(), random.uniform_float()}));
      next.origin = s.spawn(next.direction);
      Hit again;
      world.accel.intersect({&next, 1}, {&again, 1}, false);
      self += again ? 1 : 0;
    }
  }
  EXPECT_EQ(missed, 0);
  EXPECT_EQ(self, 0) << "hit again by the ray that leaves";
}

TEST(Meshes, LampsOfAllSizesInOneMeshGiveTheAnalyticIrradiance) {
  SceneBuilder builder = many_sizes(Color::Ones());
  const World world(builder.scene());
  EXPECT_EQ(world.lights.emissive_triangles(), static_cast<std::size_t>(kGreatest - kMin + 1));
  Random random(2);
  for (int e = kMin; e <= kGreatest; ++e) {
    const auto corners = triangle_of(e);
    const float side = (corners[2] - corners[0]).norm();
    const Vec3 p = (corners[0] + corners[1] + corners[2]) / 3.0f + Vec3(0, 0.3f * side, 0);
    const Vec3 n(0, -1, 0);
    double expected = 0.0;
    for (int other = kMin; other <= kGreatest; ++other) {
      std::vector<Eigen::Vector3d> polygon;
      for (const Vec3& c : triangle_of(other)) polygon.push_back(c.cast<double>());
      expected += std::abs(polygon_irradiance(polygon, p.cast<double>(), n.cast<double>()));
    }
    Moments moments;
    for (int i = 0; i < 20000; ++i) {
      const LightSample light =
          world.lights.sample(p, n, random.uniform_float(), {random.uniform_float(), random.uniform_float()});
      const float cosine = light.wi.dot(n);
      moments.add(light.pdf > 0.0f && cosine > 0.0f
                      ? static_cast<double>(light.radiance.x() * cosine / light.pdf)
                      : 0.0);
    }
    EXPECT_GT(mean_p_value(moments, expected), sidak(1e-4, 10))
        << e << ": " << moments.mean() << " for " << expected;
    EXPECT_NEAR(moments.mean(), expected, 0.03 * expected) << e;
  }
}

TEST(Meshes, SliversReflectLikeTheWholeSquare) {
  // A square metre of 200 slivers, each a millionth as wide as it is long, between two wide triangles; turned
  // any way.
  Random random(3);
  for (int turn = 0; turn < 4; ++turn) {
    SceneBuilder builder;
    const Vec3 n = turn == 0 ? Vec3(0, 0, 1) : random_direction(random);
    const Basis basis(n);
    const int m = builder.material(SceneBuilder::lambert(Color::Ones()));
    PaddedVector<Vec3> p;
    std::vector<std::array<std::uint32_t, 3>> t;
    std::vector<float> x{-0.5f};
    for (int i = 0; i <= 100; ++i) x.push_back(1e-6f * static_cast<float>(i - 50));
    x.push_back(0.5f);
    for (std::size_t i = 0; i < x.size(); ++i) {
      p.push_back(x[i] * basis.tangent - 0.5f * basis.bitangent);
      p.push_back(x[i] * basis.tangent + 0.5f * basis.bitangent);
      if (i == 0) continue;
      const auto k = static_cast<std::uint32_t>(2 * i);
      t.push_back({k - 2, k, k + 1});
      t.push_back({k - 2, k + 1, k - 1});
    }
    builder.mesh(m, p, t);
    for (const Integrator integrator : kAll) {
      // The camera sees only slivers.
      RenderOptions options;
      options.integrator = integrator;
      options.width = options.height = 16;
      options.spp = 16;
      options.cache.train_steps = 4;
      options.cache.batch = 256;
      options.environment.constant = Color::Ones();
      options.camera.look_at = LookAt{n * 1.0f, Vec3::Zero(), basis.bitangent};
      options.camera.fov_degrees = 0.003f;
      const Rendered picture = render(builder.scene(), options);
      if (integrator != Integrator::path) continue;
      EXPECT_NEAR(picture.mean(), 1.0, 1e-4) << turn << ": no sample has noise";
    }
  }
}

enum class Harm { degenerate, duplicate, flipped, loose };

/// The room with faces added or flipped in ways that must not change the picture.
scene::Scene harmed(Harm harm) {
  scene::Scene s = room();
  for (std::size_t i = 0; i < s.meshes.size(); ++i) {
    scene::Mesh& mesh = s.meshes[i];
    const scene::Material& material = s.materials[static_cast<std::size_t>(mesh.material)];
    const std::size_t count = mesh.triangles.size();
    switch (harm) {
      case Harm::degenerate:
        // Two equal corners, three equal corners, and three in a line.
        for (std::size_t t = 0; t < count; ++t) {
          const auto [a, b, c] = mesh.triangles[t];
          mesh.triangles.push_back({a, a, b});
          mesh.triangles.push_back({c, c, c});
          const auto middle = static_cast<std::uint32_t>(mesh.positions.size());
          const Vec3 p = 0.5f * (mesh.positions[a] + mesh.positions[b]);
          mesh.positions.push_back(p);
          if (!mesh.normals.empty()) mesh.normals.push_back(mesh.normals[a]);
          mesh.triangles.push_back({a, middle, b});
        }
        break;
      case Harm::duplicate:
        // A duplicated transparent face attenuates twice.
        if (material.alpha_mode != scene::AlphaMode::opaque || material.transmits()) break;
        for (std::size_t t = 0; t < count; ++t) {
          const auto [a, b, c] = mesh.triangles[t];
          mesh.triangles.push_back({b, c, a});
        }
        break;
      case Harm::flipped:
        // Opaque surfaces that emit nothing look the same from both sides.
        if (material.emits() || material.transmits()) break;
        for (std::size_t t = 0; t < count; t += 2) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
        break;
      case Harm::loose:
        // Each edge of the balls carries a third face, inwards, where it is invisible.
        if (material.transmits() || mesh.normals.empty()) break;
        for (std::size_t t = 0; t < count; ++t) {
          const auto [a, b, c] = mesh.triangles[t];
          const auto inner = static_cast<std::uint32_t>(mesh.positions.size());
          mesh.positions.push_back(0.5f * (mesh.positions[a] + mesh.positions[b]) - 0.2f * mesh.normals[a]);
          mesh.normals.push_back(mesh.normals[a]);
          mesh.triangles.push_back({a, b, inner});
        }
        break;
    }
  }
  return s;
}

TEST(Meshes, RedundantFacesDoNotChangeThePicture) {
  const char* names[] = {"degenerate", "duplicate", "flipped", "with a third face at each edge"};
  for (const Integrator integrator : kAll) {
    RenderOptions options = mesh_picture(integrator);
    const Rendered clean = render(room(), options);
    RenderOptions again = options;
    again.seed = 1;
    const double noise = block_error(clean, render(room(), again), options.width);
    for (const Harm harm : {Harm::degenerate, Harm::duplicate, Harm::flipped, Harm::loose}) {
      const Rendered picture = render(harmed(harm), again);
      const double error = block_error(clean, picture, options.width);
      EXPECT_LT(error, 8.0 * noise) << names[static_cast<int>(harm)];
    }
  }
}

TEST(Meshes, ASceneOfOneTriangleRenders) {
  for (const Integrator integrator : kAll) {
    for (const bool shines : {false, true}) {
      SceneBuilder builder;
      const int m = builder.material(
          SceneBuilder::lambert(Color::Constant(0.5f), Color::Constant(shines ? 1.0f : 0.0f)));
      builder.mesh(m, {Vec3(-9, -9, 0), Vec3(9, -9, 0), Vec3(0, 9, 0)}, {{0, 1, 2}});
      RenderOptions options = mesh_picture(integrator);
      options.camera.look_at = LookAt{{0, 0, 1}, {0, 0, 0}, {0, 1, 0}};
      options.environment.constant = Color::Ones();
      const Rendered picture = render(builder.scene(), options);
      const bool occlusion = integrator == Integrator::ao || integrator == Integrator::nao;
      const double expected = occlusion ? 1.0 : shines ? 1.5 : 0.5;
      if (!uses_cache(integrator)) {
        EXPECT_NEAR(picture.mean() / expected, 1.0, 0.01) << enum_name(integrator);
      }
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer

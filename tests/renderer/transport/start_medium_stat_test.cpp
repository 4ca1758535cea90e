// Rays of cameras that are inside of bodies: Beer's law, and furnaces.

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/film/camera_choice.h"
#include "renderer/render.h"
#include "tests/renderer/cache/cached_pictures.h"
#include "tests/support/absorbing_bodies.h"
#include "tests/support/materials.h"
#include "tests/support/picture_moments.h"
#include "tests/support/scene_builder.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::AbsorbingBodies;
using testing::channel_moments;
using testing::Moments;
using testing::SceneBuilder;

// Of the means of this file.
const double kStartSignificance = testing::sidak(1e-4, 16);

void expect_start_mean(const Moments& moments, double expected) {
  EXPECT_GT(testing::mean_p_value(moments, expected, 1e-4), kStartSignificance)
      << "mean " << moments.mean() << " +- " << moments.standard_error() << ", expected " << expected;
}

/// A camera in a body, or in a body inside of it, or in neither.
struct Pool : AbsorbingBodies {
  Pool() {
    add(Box(Vec3(-0.4f, -0.3f, -0.5f), Vec3(0.6f, 0.2f, 0.1f)), Color(0.9f, 0.1f, 0.0f));
    add(Box(Vec3(-2, -1, -3), Vec3(2, 3, 1.5f)), Color(0.1f, 0.2f, 0.3f));
  }
};

const LookAt kInOuter{Vec3(1, 0.5f, 1), Vec3(0, 0, -0.2f), Vec3(0, 1, 0)};
const LookAt kInInner{Vec3(0.1f, 0, -0.1f), Vec3(1, 0.5f, -2), Vec3(0, 1, 0)};
const LookAt kBeside{Vec3(2.5f, 0.5f, 1), Vec3(0, 0, -0.2f), Vec3(0, 1, 0)};

TEST(StartMedium, FollowsBeersLawForAllProjections) {
  for (const LookAt& view : {kInOuter, kInInner, kBeside}) {
    for (const Projection projection :
         {Projection::perspective, Projection::orthographic, Projection::panorama}) {
      Pool pool;
      pool.options.camera.look_at = view;
      pool.options.camera.projection = projection;
      // Wide enough for rays that begin beside the bodies.
      if (projection == Projection::orthographic) pool.options.camera.view_height = 6.0f;
      SCOPED_TRACE(::testing::Message() << view.eye.transpose() << ", " << static_cast<int>(projection));
      pool.expect_beers_law();
    }
  }
}

TEST(StartMedium, IsThatOfAnOnlyBody) {
  // Without another one nearby it is none of World::media.
  for (const float x : {0.0f, 2.5f}) {
    AbsorbingBodies body;
    body.add(Box(Vec3(-1, -1, -1), Vec3(1, 1, 1)), Color(0.5f, 1.0f, 0.0f));
    body.options.camera.look_at = LookAt{Vec3(x, 0.3f, 0.2f), Vec3(-2, 0, 0), Vec3(0, 1, 0)};
    body.expect_beers_law();
  }
}

TEST(StartMedium, BesideABodyIsAir) {
  AbsorbingBodies body;
  body.add(Box(Vec3(-1, -1, -1), Vec3(1, 1, 1)), Color::Constant(3.0f));
  body.options.camera.look_at = LookAt{Vec3(0, 0, 1.001f), Vec3(0, 0, 9), Vec3(0, 1, 0)};
  const Picture picture = body.picture();
  for (const float value : picture.layers[0].values) ASSERT_EQ(value, 1.0f);
}

TEST(StartMedium, IsThatBehindTheNearPlane) {
  for (const Projection projection :
       {Projection::perspective, Projection::orthographic, Projection::panorama}) {
    for (const float near : {1.5f, 2.6f, 9.0f}) {  // in the outer body, in the inner one, behind both
      Pool pool;
      pool.options.camera.look_at = LookAt{Vec3(0, 0, 2.5f), Vec3(0, 0, 0), Vec3(0, 1, 0)};
      pool.options.camera.projection = projection;
      pool.options.camera.clip.near = near;
      SCOPED_TRACE(::testing::Message() << static_cast<int>(projection) << ", near " << near);
      pool.expect_beers_law();
    }
  }
}

/// A block that ends at x = 0, one metre before the camera's plane.
AbsorbingBodies half_a_block() {
  AbsorbingBodies bodies;
  bodies.add(Box(Vec3(0, -40, -1), Vec3(40, 40, 40)), Color::Constant(1.2f));
  bodies.options.width = bodies.options.height = 16;
  bodies.options.spp = 64;
  bodies.options.camera.look_at = LookAt{Vec3(0, 0, 0), Vec3(0, 0, -1), Vec3(0, 1, 0)};
  bodies.options.camera.fov_degrees = 0.01f;
  return bodies;
}

TEST(StartMedium, DiffersOverTheLens) {
  AbsorbingBodies bodies = half_a_block();
  // Nearly parallel rays, half of which start in the block.
  bodies.options.camera.lens.aperture = 1.0f;
  bodies.options.camera.lens.focus = "1e5";
  expect_start_mean(channel_moments(bodies.picture(), 1), 0.5 + 0.5 * std::exp(-1.2));
}

/// An open shutter, of a scene in which nothing moves yet.
scene::ShutterMotion& with_open_shutter(scene::Scene& scene) {
  scene::ShutterMotion& shutter = scene.shutter;
  shutter.is_open = true;
  shutter.transforms.resize(scene.instances.size());
  shutter.vertices.resize(scene.meshes.size());
  shutter.lights.resize(scene.lights.size());
  shutter.cameras.resize(scene.cameras.size());
  return shutter;
}

TEST(StartMedium, DiffersAlongTheWayOfACamera) {
  AbsorbingBodies bodies = half_a_block();
  bodies.options.camera.look_at.reset();
  scene::Camera camera, last;
  camera.transform.translation().x() = -3.0f;
  last.transform.translation().x() = 1.0f;
  bodies.scene().cameras = {camera};
  with_open_shutter(bodies.scene()).cameras[0] = {camera, last};
  expect_start_mean(channel_moments(bodies.picture(), 1), 0.75 + 0.25 * std::exp(-1.2));
}

TEST(StartMedium, DiffersWhereABodyMoves) {
  for (const bool another : {false, true}) {
    AbsorbingBodies bodies = half_a_block();
    if (another) bodies.add(Box(Vec3(-41, -1, 2), Vec3(41, 1, 3)), Color::Zero());
    scene::Instance& instance = bodies.scene().instances[0];
    instance.moves = true;
    bodies.scene().motion.instances = true;
    instance.baked = false;
    scene::ShutterMotion& shutter = with_open_shutter(bodies.scene());
    shutter.instances = true;
    Affine begin = Affine::Identity(), end = Affine::Identity();
    begin.translation().x() = 1.0f;
    end.translation().x() = -3.0f;
    shutter.transforms[0] = {begin, end};
    expect_start_mean(channel_moments(bodies.picture(), 1), 0.25 + 0.75 * std::exp(-1.2));
  }
}

/// A picture from inside a ball in a sky of radiance 1. No light that reaches the camera is totally
/// reflected.
Moments furnace_inside(const scene::Material& material, bool another) {
  SceneBuilder builder;
  builder.sphere(builder.material(material), Vec3::Zero(), 1.0f, 48, true);
  builder.scene().instances.back().placement = 0;
  if (another) {
    builder.sphere(builder.material(material), Vec3(1.7f, 0, 0), 0.8f, 48, true);
    builder.scene().instances.back().placement = 1;
  }
  RenderOptions options;
  options.width = options.height = 16;
  options.spp = 16;
  options.max_depth = options.min_depth = 10000;
  options.environment.constant = Color::Ones();
  options.camera.look_at = LookAt{Vec3(-0.2f, 0.1f, 0.1f), Vec3(-1, 0.4f, 0.2f), Vec3(0, 1, 0)};
  options.camera.fov_degrees = 70.0f;
  return channel_moments(Renderer(builder.scene(), options).render(), 1);
}

TEST(StartMedium, OfALosslessBodyInAFurnaceHasItsSquaredIndex) {
  for (const bool another : {false, true}) {
    for (const float ior : {1.0f, 1.5f}) {
      SCOPED_TRACE(::testing::Message() << ior << another);
      scene::Material material = testing::solid_glass(ior);
      expect_start_mean(furnace_inside(material, another), static_cast<double>(ior * ior));
      material.attenuation_distance = 0.3f;
      material.attenuation_color.setConstant(0.4f);
      material.multiscatter_color.setOnes();
      expect_start_mean(furnace_inside(material, another), static_cast<double>(ior * ior));
    }
  }
}

TEST(StartMedium, OfGlassShowsALampThroughOneBoundary) {
  SceneBuilder builder;
  builder.quad(builder.material(SceneBuilder::lambert(Color::Zero(), Color::Ones())), Vec3(-50, -50, -1),
               Vec3(100, 0, 0), Vec3(0, 100, 0));
  builder.box(builder.material(testing::solid_glass()), Vec3(-40, -40, 0), Vec3(40, 40, 9));
  builder.scene().instances.back().placement = 0;
  RenderOptions options;
  options.width = options.height = 16;
  options.spp = 256;
  options.max_depth = options.min_depth = 100;
  options.camera.look_at = LookAt{Vec3(0.1f, 0.2f, 5), Vec3(0.1f, 0.2f, 0), Vec3(0, 1, 0)};
  options.camera.fov_degrees = 0.2f;
  // What the boundary reflects comes back from the one behind the camera: (1 - r) n^2 / (1 - r^2).
  expect_start_mean(channel_moments(Renderer(builder.scene(), options).render(), 1), 1.5 * 1.5 / 1.04);
}

TEST(StartMedium, IsThatOfCachedPaths) {
  // A lit room in tinted water. The cache learns at places that are all in it.
  SceneBuilder builder = testing::closed_furnace(0.5f, 1.0f);
  scene::Material water = testing::solid_glass(1.0f);
  water.attenuation_distance = 1.0f;
  water.attenuation_color = Color(0.5f, 0.7f, 0.9f);
  builder.box(builder.material(water), Vec3(-4, -4, -4), Vec3(4, 4, 4));
  builder.scene().instances.back().placement = 0;
  RenderOptions options = cached_picture(Integrator::nrc);
  options.cache.train_steps = 150;
  const Picture cached = Renderer(builder.scene(), options).render();
  options.integrator = Integrator::path;
  options.spp = 16;
  const Picture paths = Renderer(builder.scene(), options).render();
  for (const std::size_t c : {0u, 1u, 2u}) {
    const double expected = channel_moments(paths, c).mean();
    EXPECT_NEAR(channel_moments(cached, c).mean(), expected, 0.02 * expected) << c;
  }
  EXPECT_LT(channel_moments(paths, 0).mean(), 0.8 * channel_moments(paths, 2).mean()) << "it is tinted";
}

}  // namespace
}  // namespace gatelight::renderer

// Guides of the denoiser are those of the first surface that is neither a mirror nor clear.

#include <gtest/gtest.h>

#include <vector>

#include "renderer/render.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {
using testing::SceneBuilder;

/// The camera at the origin looks at a square, two metres before it. Far ahead is nothing but sky; five
/// metres behind the square, along its mirrored rays, is a wall.
scene::Scene scene_with(const scene::Material& square, bool wall_ahead) {
  SceneBuilder builder;
  builder.quad(builder.material(square), Vec3(-2, -2, -2), Vec3(4, 0, 0), Vec3(0, 4, 0));
  const int wall = builder.material(SceneBuilder::lambert(Color(0.2f, 0.4f, 0.6f)));
  if (wall_ahead) {
    builder.quad(wall, Vec3(-20, -20, -5), Vec3(40, 0, 0), Vec3(0, 40, 0));
  } else {
    builder.quad(wall, Vec3(20, -20, 3), Vec3(-40, 0, 0), Vec3(0, 40, 0));
  }
  return builder.scene();
}

class GuideSurfaces : public ::testing::TestWithParam<Integrator> {
 protected:
  Picture render(const scene::Scene& scene) const {
    RenderOptions options;
    options.integrator = GetParam();
    options.width = options.height = 8;
    options.spp = 2;
    options.camera.look_at = LookAt{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}};
    options.camera.fov_degrees = 5.0f;
    options.environment.constant = Color(0.5f, 0.5f, 0.5f);
    options.aovs = {Aov::denoising, Aov::albedo, Aov::depth};
    options.cache.train_steps = 2;
    options.cache.batch = 200;
    options.cache.query_at = QueryAt::gather;
    return Renderer(scene, options).render();
  }
  static void expect_layer(const Picture& picture, const char* name, const std::vector<float>& value,
                           float within) {
    SCOPED_TRACE(name);
    const Layer* const layer = picture.find(name);
    ASSERT_TRUE(layer);
    for (std::size_t i = 0; i < layer->values.size(); ++i)
      ASSERT_NEAR(layer->values[i], value[i % value.size()], within) << i;
  }
};

scene::Material mirror(float roughness) {
  scene::Material m;
  m.base_color = Color(0.9f, 0.8f, 0.5f);
  m.metallic = 1.0f;
  m.roughness = roughness;
  return m;
}

TEST_P(GuideSurfaces, LieBehindAMirror) {
  const Picture picture = render(scene_with(mirror(0.0f), false));
  expect_layer(picture, "denoising-normal", {0.0f, 0.0f, -1.0f}, 1e-5f);
  expect_layer(picture, "denoising-albedo", {0.9f * 0.2f, 0.8f * 0.4f, 0.5f * 0.6f}, 0.01f);
  // Output variables are those of the primary hit.
  expect_layer(picture, "depth", {2.0f}, 0.02f);
  expect_layer(picture, "albedo", {0.9f, 0.8f, 0.5f}, 0.02f);
}

TEST_P(GuideSurfaces, LieBehindAPane) {
  scene::Material pane = SceneBuilder::clear_glass();
  pane.specular = 0.0f;  // it reflects nothing
  pane.base_color = Color(0.5f, 1.0f, 1.0f);
  const Picture picture = render(scene_with(pane, true));
  expect_layer(picture, "denoising-normal", {0.0f, 0.0f, 1.0f}, 1e-5f);
  expect_layer(picture, "denoising-albedo", {0.1f, 0.4f, 0.6f}, 0.01f);
  expect_layer(picture, "depth", {2.0f}, 0.02f);
}

TEST_P(GuideSurfaces, AreNoSkyBehindAMirror) {
  const Picture picture = render(scene_with(mirror(0.0f), true));
  expect_layer(picture, "denoising-albedo", {0.0f}, 0.0f);
}

TEST_P(GuideSurfaces, AreRoughMetalAndVarnishThemselves) {
  scene::Material varnish = SceneBuilder::lambert(Color(0.9f, 0.8f, 0.5f));
  varnish.clearcoat = 1.0f;
  varnish.clearcoat_roughness = 0.0f;
  for (const scene::Material& square : {mirror(0.5f), varnish}) {
    const Picture picture = render(scene_with(square, false));
    expect_layer(picture, "denoising-normal", {0.0f, 0.0f, 1.0f}, 1e-5f);
    EXPECT_EQ(picture.find("denoising-albedo")->values, picture.find("albedo")->values);
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, GuideSurfaces, ::testing::Values(Integrator::path, Integrator::nrc),
                         [](const auto& kind) { return kind.param == Integrator::path ? "path" : "nrc"; });

}  // namespace
}  // namespace gatelight::renderer

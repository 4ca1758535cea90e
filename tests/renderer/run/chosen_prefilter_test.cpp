// Views with and without noise in what guides the denoiser, and what it reads for them.

#include "renderer/run/chosen_prefilter.h"

#include <gtest/gtest.h>

#include "renderer/film/camera_choice.h"
#include "renderer/render.h"
#include "renderer/settings/words.h"
#include "tests/support/denoiser.h"
#include "tests/support/room.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {

using scene::Color;
using scene::Vec3;
using testing::SceneBuilder;

/// Squares of two colours side by side, some metres before the camera.
scene::Scene squares() {
  SceneBuilder builder;
  builder.quad(builder.material(SceneBuilder::lambert(Color::Constant(0.9f))), Vec3(-9, -9, -5),
               Vec3(9, 0, 0), Vec3(0, 18, 0));
  builder.quad(builder.material(SceneBuilder::lambert(Color(0.9f, 0.1f, 0.1f))), Vec3(0, -9, -5),
               Vec3(9, 0, 0), Vec3(0, 18, 0));
  return builder.scene();
}

RenderOptions options_of(float aperture = 0.0f) {
  RenderOptions options = testing::small_picture();
  options.environment.constant = Color::Ones();
  options.camera.look_at = LookAt{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  options.camera.lens.aperture = aperture;
  options.camera.lens.focus = "1";
  return options;
}

double share(const scene::Scene& scene, const RenderOptions& options) {
  const World world(scene, options.environment, options.light_selection, {}, options.glass_shadows);
  const Camera camera(choose_camera(scene, options.camera, 1.5f), options.width, options.height);
  return noisy_share_of_guides(world, camera, {0, 0, options.width, options.height}, options);
}

TEST(ChosenPrefilter, TellsNoiseFromEdges) {
  EXPECT_EQ(share(squares(), options_of()), 0.0) << "an edge is no noise";
  EXPECT_GT(share(squares(), options_of(0.2f)), 0.01) << "a lens blurs it";
  SceneBuilder builder;
  builder.quad(builder.material(SceneBuilder::lambert(Color::Constant(0.9f))), Vec3(-9, -9, -5),
               Vec3(18, 0, 0), Vec3(0, 18, 0));
  scene::Material half = SceneBuilder::lambert(Color(0.1f, 0.1f, 0.9f));
  half.alpha_mode = scene::AlphaMode::blend;
  half.base_alpha = 0.5f;
  builder.quad(builder.material(half), Vec3(-9, -9, -4), Vec3(18, 0, 0), Vec3(0, 18, 0));
  EXPECT_GT(share(builder.scene(), options_of()), 0.4) << "each path passes it or not";
}

TEST(ChosenPrefilter, IsAccurateWhereGuidesHaveNoise) {
  GATELIGHT_NEEDS_DENOISER();
  const scene::Scene scene = squares();
  const auto prefilter_of = [&](float aperture, int spp, Prefilter asked) {
    RenderOptions options = options_of(aperture);
    options.spp = spp;
    options.denoise = {
        .denoiser = DenoiserKind::oidn, .prefilter = asked, .library = testing::denoiser_place()};
    Renderer renderer(scene, options);
    renderer.render();
    return word(renderer.statistics().prefilter);
  };
  EXPECT_EQ(prefilter_of(0.0f, 32, Prefilter::automatic), "none");
  EXPECT_EQ(prefilter_of(0.0f, 31, Prefilter::automatic), "accurate") << "edges have noise yet";
  EXPECT_EQ(prefilter_of(2.0f, 32, Prefilter::automatic), "accurate");
  EXPECT_EQ(prefilter_of(2.0f, 32, Prefilter::fast), "fast") << "naming them wins";
}

}  // namespace
}  // namespace gatelight::renderer

// A renderer that is given other options makes the pictures of a new one.

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "base/errors.h"
#include "renderer/render.h"
#include "scene/gltf.h"

namespace gatelight::renderer {
namespace {

RenderOptions first_options() {
  RenderOptions options;
  options.width = 24;
  options.height = 16;
  options.spp = 2;
  options.threads = 2;
  options.environment.automatic = true;
  return options;
}

std::vector<float> colors_of(const Picture& picture) {
  return picture.layers.front().values;
}

struct Change {
  const char* name;
  std::function<void(RenderOptions&)> apply;
};

const std::vector<Change>& changes() {
  static const std::vector<Change> all = {
      {"size", [](RenderOptions& o) { o.width = 40; }},
      {"samples and seed", [](RenderOptions& o) { o.spp = 3, o.seed = 7; }},
      {"sampler", [](RenderOptions& o) { o.sampler = SamplerKind::independent; }},
      {"environment", [](RenderOptions& o) { o.environment = {.constant = Color(1.0f, 2.0f, 3.0f)}; }},
      {"sky", [](RenderOptions& o) { o.environment = {.sky = SkyOptions{}}; }},
      {"its rotation", [](RenderOptions& o) { o.environment.rotation_degrees = 40.0f; }},
      {"shadows of glass", [](RenderOptions& o) { o.glass_shadows = GlassShadows::straight; }},
      {"light selection", [](RenderOptions& o) { o.light_selection = LightSelection::power; }},
      {"filter", [](RenderOptions& o) { o.filter = PixelFilter::box; }},
      {"region",
       [](RenderOptions& o) {
         o.region = {{3, 2, 30, 12}};
       }},
      {"ISA", [](RenderOptions& o) { o.isa = "scalar"; }},
      {"a cache",
       [](RenderOptions& o) {
         o.integrator = Integrator::nrc;
         o.cache.train_steps = 4;
         o.cache.batch = 256;
       }},
      {"a background", [](RenderOptions& o) { o.background.kind = BackgroundOptions::Kind::transparent; }},
      {"occlusion", [](RenderOptions& o) { o.integrator = Integrator::ao; }},
  };
  return all;
}

TEST(RendererOptions, OfAnOldRendererMakeThePicturesOfANewOne) {
  const scene::Scene scene = scene::load_gltf(GATELIGHT_DATA "/material-grid.glb");
  RenderOptions options = first_options();
  Renderer renderer(scene, options);
  renderer.render();
  std::vector<float> before;
  for (const Change& change : changes()) {
    change.apply(options);
    renderer.set_options(options);
    const std::vector<float> colors = colors_of(renderer.render());
    EXPECT_EQ(colors, colors_of(Renderer(scene, options).render())) << change.name;
    EXPECT_NE(colors, before) << change.name;
    before = colors;
  }
  // And back again.
  renderer.set_options(first_options());
  EXPECT_EQ(colors_of(renderer.render()), colors_of(Renderer(scene, first_options()).render()));
}

TEST(RendererOptions, CanBeMendedAfterWrongOnes) {
  const scene::Scene scene = scene::load_gltf(GATELIGHT_DATA "/cornell-box.glb");
  RenderOptions options = first_options();
  Renderer renderer(scene, options);
  RenderOptions wrong = options;
  wrong.region = {{0, 0, 5000, 10}};
  EXPECT_THROW(renderer.set_options(wrong), BadOption);
  wrong = options;
  wrong.environment = {.file = "no-such.exr"};
  EXPECT_THROW(renderer.set_options(wrong), InputError);
  wrong = options;
  wrong.threads = 3;
  EXPECT_THROW(renderer.set_options(wrong), BadOption);
  renderer.set_options(options);
  EXPECT_EQ(colors_of(renderer.render()), colors_of(Renderer(scene, options).render()));
}

TEST(RendererOptions, FramesOfTwoSizesShareACache) {
  const scene::Scene scene = scene::load_gltf(GATELIGHT_DATA "/cornell-box.glb");
  RenderOptions options = first_options();
  options.integrator = Integrator::nrc;
  options.cache.source = TrainingSource::picture;
  options.cache.train_steps = 40;
  options.cache.batch = 2048;
  Renderer renderer(scene, options);
  renderer.begin_frames(0.0);
  renderer.render_frame(0);
  EXPECT_EQ(renderer.statistics().cache.steps, 40u);
  options.width = 48;
  options.height = 32;
  options.cache.train_steps = 80;
  renderer.set_options(options);
  const Picture picture = renderer.render_frame(1);
  EXPECT_EQ(picture.width, 48);
  EXPECT_EQ(renderer.statistics().cache.steps, 40u) << "half the steps of a new cache: it knows the scene";
}

}  // namespace
}  // namespace gatelight::renderer

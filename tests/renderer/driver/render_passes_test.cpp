// The render passes add up to the picture, do not change it, and each has the light that its name says.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/render.h"
#include "tests/support/denoiser.h"
#include "tests/support/grouped_lights.h"
#include "tests/support/light_scenes.h"

namespace gatelight::renderer {
namespace {

using testing::lit_by_all;
using testing::SceneBuilder;
using testing::view_of_all;

class RenderPassLayers : public ::testing::Test {
 protected:
  RenderOptions options() const {
    RenderOptions options = view_of_all();
    options.light_groups.clear();
    options.environment = sky;
    options.aovs = all_passes();
    options.aovs.push_back(Aov::raw);
    options.cache.train_steps = 4;
    options.cache.batch = 512;
    return options;
  }

  Picture rendered(const RenderOptions& options) const { return Renderer(scene, options).render(); }

  tests::TemporaryFolder folder;
  EnvironmentOptions sky = testing::uniform_picture(folder, 0.2f);
  scene::Scene scene = lit_by_all();
};

const std::vector<float>& pass(const Picture& picture, Aov aov) {
  return picture.find(std::string(info_of(aov).name))->values;
}

double sum_of(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float value : values) sum += static_cast<double>(value);
  return sum;
}

/// The passes add up to these values.
void expect_sum(const Picture& picture, const std::vector<float>& whole) {
  for (std::size_t i = 0; i < whole.size(); ++i) {
    double sum = 0.0, size = 0.0;
    for (const Aov aov : all_passes()) {
      sum += static_cast<double>(pass(picture, aov)[i]);
      size += std::abs(static_cast<double>(pass(picture, aov)[i]));
    }
    ASSERT_NEAR(sum, static_cast<double>(whole[i]), 2e-6 * (size + 1e-3)) << i;
  }
}

using Change = std::pair<const char*, std::function<void(RenderOptions&)>>;

const std::vector<Change> kOfPaths = {
    {"plain", [](RenderOptions&) {}},
    {"light groups", [](RenderOptions& o) { o.light_groups = testing::groups_of_all(); }},
    {"clamped", [](RenderOptions& o) { o.clamp = 0.5f; }},
    {"unrefracted glass", [](RenderOptions& o) { o.glass_shadows = GlassShadows::straight; }},
    {"only direct light", [](RenderOptions& o) { o.max_depth = 1; }},
    {"BSDF sampling without MIS", [](RenderOptions& o) { o.direct = DirectLight::bsdf; }},
};

void use_cache(RenderOptions& o, QueryAt query_at, CachedComponent component, TrainingSource source) {
  o.integrator = Integrator::nrc;
  o.cache.query_at = query_at;
  o.cache.component = component;
  o.cache.source = source;
  o.cache.candidates = 1;
  o.cache.samples_from_step = 2;
}

std::vector<Change> of_cache() {
  std::vector<Change> changes;
  for (const QueryAt query_at : {QueryAt::primary, QueryAt::gather, QueryAt::spread, QueryAt::none}) {
    for (const CachedComponent component :
         {CachedComponent::all, CachedComponent::no_delta, CachedComponent::indirect})
      changes.emplace_back(
          "cache", [=](RenderOptions& o) { use_cache(o, query_at, component, TrainingSource::camera); });
  }
  changes.emplace_back("samples of training", [](RenderOptions& o) {
    use_cache(o, QueryAt::spread, CachedComponent::all, TrainingSource::picture);
  });
  return changes;
}

TEST_F(RenderPassLayers, AddUpAndDoNotChangeThePicture) {
  std::vector<Change> changes = kOfPaths;
  for (Change& change : of_cache()) changes.push_back(std::move(change));
  for (const auto& [name, change] : changes) {
    SCOPED_TRACE(name);
    RenderOptions o = options();
    change(o);
    const Picture picture = rendered(o);
    expect_sum(picture, pass(picture, Aov::raw));
    o.aovs = {Aov::raw};
    EXPECT_EQ(rendered(o).layers.front().values, picture.layers.front().values);
  }
}

TEST_F(RenderPassLayers, AddUpToTheDenoisedPictureIfTheyAreDenoised) {
  GATELIGHT_NEEDS_DENOISER();
  RenderOptions o = options();
  testing::denoise(o);
  const Picture noisy = rendered(o);
  expect_sum(noisy, pass(noisy, Aov::raw));
  o.denoise.parts = true;
  o.light_groups = testing::groups_of_all();
  const Picture picture = rendered(o);
  EXPECT_EQ(picture.layers.front().values, noisy.layers.front().values);
  expect_sum(picture, picture.layers.front().values);
  EXPECT_NE(pass(picture, Aov::diffuse_direct), pass(noisy, Aov::diffuse_direct));
}

TEST_F(RenderPassLayers, AreKeptOnlyIfTheyAreWanted) {
  RenderOptions o = options();
  const Picture all = rendered(o);
  o.aovs = {Aov::glossy_direct, Aov::background};
  const Picture two = rendered(o);
  ASSERT_EQ(two.layers.size(), 3u);
  for (const Aov aov : o.aovs) EXPECT_EQ(pass(two, aov), pass(all, aov));
}

/// A ball of one material under a lamp and a sky that is uniform.
class OneBall : public RenderPassLayers {
 protected:
  Picture of(const scene::Material& material, int max_depth, Integrator integrator = Integrator::path) {
    SceneBuilder builder;
    builder.sphere(builder.material(material), Vec3(0, 0, 0), 1.0f, 32, true);
    builder.quad(builder.material(SceneBuilder::lambert(Color::Zero(), Color::Constant(4.0f))),
                 Vec3(-1, 1.5f, 1), Vec3(0, 0, -2), Vec3(2, 0, 0));
    scene = builder.scene();
    RenderOptions o = options();
    o.integrator = integrator;
    o.camera.look_at = LookAt{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}};
    o.max_depth = max_depth;
    return rendered(o);
  }

  /// Only these passes have light.
  static void expect_light(const Picture& picture, const std::vector<Aov>& lit) {
    for (const Aov aov : all_passes())
      EXPECT_EQ(sum_of(pass(picture, aov)) > 0.0, has(lit, aov)) << info_of(aov).name;
  }
};

TEST_F(OneBall, SplitsLightByLobesAndBounces) {
  scene::Material metal;
  metal.metallic = 1.0f;
  metal.roughness = 0.2f;
  scene::Material glass;
  glass.metallic = glass.roughness = 0.0f;
  glass.transmission = glass.thickness = 1.0f;
  scene::Material sheen = SceneBuilder::lambert(Color::Zero());
  sheen.sheen_color = Color::Constant(0.5f);
  sheen.sheen_roughness = 0.5f;
  const std::vector<Aov> seen = {Aov::emission, Aov::background};
  const auto with = [&](std::vector<Aov> more) {
    more.insert(more.end(), seen.begin(), seen.end());
    return more;
  };
  expect_light(of(SceneBuilder::lambert(Color::Constant(0.5f)), 1), with({Aov::diffuse_direct}));
  expect_light(of(sheen, 1), with({Aov::diffuse_direct}));
  expect_light(of(metal, 1), with({Aov::glossy_direct}));
  expect_light(of(glass, 1), with({Aov::glossy_direct}));
  // What leaves the glass again has scattered twice.
  expect_light(of(glass, 2), with({Aov::glossy_direct, Aov::transmission_indirect}));
}

TEST_F(OneBall, PanesAreNoScatteringEvents) {
  const Picture picture = of(SceneBuilder::clear_glass(), 3);
  EXPECT_GT(sum_of(pass(picture, Aov::background)) + sum_of(pass(picture, Aov::emission)),
            0.9 * sum_of(pass(picture, Aov::raw)));
  EXPECT_EQ(sum_of(pass(picture, Aov::diffuse_direct)), 0.0);
}

/// Under a uniform sky of radiance one a convex Lambert surface reflects its albedo, all of it direct.
TEST_F(OneBall, DirectDiffuseLightOfAFurnaceIsTheAlbedo) {
  SceneBuilder builder;
  builder.sphere(builder.material(SceneBuilder::lambert(Color(0.2f, 0.5f, 0.8f))), Vec3(0, 0, 0), 1.0f, 32,
                 true);
  scene = builder.scene();
  RenderOptions o = options();
  o.environment = {};
  o.environment.constant = Color::Ones();
  o.camera.look_at = LookAt{{0, 0, 2.0f}, {0, 0, 0}, {0, 1, 0}};
  o.region = {{20, 12, 28, 20}};
  o.spp = 64;
  const Picture picture = rendered(o);
  const std::vector<float>& direct = pass(picture, Aov::diffuse_direct);
  constexpr double kAlbedo[] = {0.2, 0.5, 0.8};
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0.0;
    for (std::size_t i = c; i < direct.size(); i += 3) sum += static_cast<double>(direct[i]);
    EXPECT_NEAR(3.0 * sum / static_cast<double>(direct.size()), kAlbedo[c], 0.005);
  }
}

}  // namespace
}  // namespace gatelight::renderer

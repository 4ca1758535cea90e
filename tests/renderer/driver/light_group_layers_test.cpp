// The layers of groups of lights add up to the picture, and do not change it.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "base/simd/isa.h"
#include "renderer/render.h"
#include "renderer/settings/enum_names.h"
#include "tests/support/denoiser.h"
#include "tests/support/environment_variable.h"
#include "tests/support/grouped_lights.h"
#include "tests/support/light_scenes.h"
#include "tests/support/messages.h"

namespace gatelight::renderer {
namespace {

using testing::lit_by_all;
using testing::view_of_all;
using tests::expect_refused_parts;

class LightLayers : public ::testing::Test {
 protected:
  RenderOptions options() const {
    RenderOptions options = view_of_all();
    options.environment = sky;
    options.aovs = {Aov::raw};
    return options;
  }

  tests::TemporaryFolder folder;
  EnvironmentOptions sky = testing::uniform_picture(folder, 0.2f);
  scene::Scene scene = lit_by_all();
};

Picture rendered(const scene::Scene& scene, const RenderOptions& options) {
  return Renderer(scene, options).render();
}

std::vector<const Layer*> groups_of(const Picture& picture) {
  std::vector<const Layer*> layers;
  for (const Layer& layer : picture.layers) {
    if (layer.name.starts_with("light-")) layers.push_back(&layer);
  }
  return layers;
}

/// Every pixel of the samples' mean is the sum of the groups; none of them is black or the whole.
void expect_sum(const Picture& picture, std::size_t groups) {
  const std::vector<const Layer*> layers = groups_of(picture);
  ASSERT_EQ(layers.size(), groups);
  const Layer& raw = *picture.find("raw");
  for (const Layer* layer : layers) {
    EXPECT_EQ(layer->channels, raw.channels);
    EXPECT_TRUE(layer->full_precision);
    EXPECT_NE(layer->values, std::vector<float>(raw.values.size())) << layer->name << " is black";
    EXPECT_TRUE(groups == 1 || layer->values != raw.values) << layer->name << " is the whole";
  }
  for (std::size_t i = 0; i < raw.values.size(); ++i) {
    double sum = 0.0;
    for (const Layer* layer : layers) sum += static_cast<double>(layer->values[i]);
    const auto mean = static_cast<double>(raw.values[i]);
    ASSERT_NEAR(sum, mean, 1e-6 * std::abs(mean)) << i;
  }
}

/// Embree keeps its own instruction set.
TEST_F(LightLayers, AddUpAndHaveTheSameBitsOnEveryInstructionSet) {
  for (const SamplerKind sampler : {SamplerKind::sobol, SamplerKind::independent}) {
    RenderOptions o = options();
    o.sampler = sampler;
    o.aovs.push_back(Aov::albedo);
    std::optional<Picture> first;
    for (const simd::Isa isa : simd::available_isas()) {
      SCOPED_TRACE(simd::isa_name(isa));
      const tests::EnvironmentVariable chosen("GATELIGHT_ISA", std::string(simd::isa_name(isa)));
      const Picture picture = rendered(scene, o);
      expect_sum(picture, 6);
      EXPECT_EQ(groups_of(picture)[0]->name, "light-bulb");
      EXPECT_EQ(groups_of(picture)[5]->name, "light-rest");
      if (!first) first = picture;
      for (std::size_t i = 0; i < picture.layers.size(); ++i)
        EXPECT_EQ(picture.layers[i].values, first->layers[i].values) << picture.layers[i].name;
    }
  }
}

TEST_F(LightLayers, AddUpForAllOptions) {
  GATELIGHT_NEEDS_DENOISER();
  const std::vector<std::pair<const char*, std::function<void(RenderOptions&)>>> changes = {
      {"denoised",
       [](RenderOptions& o) {
         testing::denoise(o);
         o.spp = 11;
       }},
      {"clamped", [](RenderOptions& o) { o.clamp = 0.5f; }},
      {"denoised and clamped",
       [](RenderOptions& o) {
         testing::denoise(o);
         o.clamp = 0.5f;
       }},
      {"lights by power", [](RenderOptions& o) { o.light_selection = LightSelection::power; }},
      {"BSDF sampling without MIS", [](RenderOptions& o) { o.direct = DirectLight::bsdf; }},
      {"unrefracted glass", [](RenderOptions& o) { o.glass_shadows = GlassShadows::straight; }},
      {"transparent", [](RenderOptions& o) { o.background.kind = BackgroundOptions::Kind::transparent; }},
      {"region and independent numbers", [](RenderOptions& o) {
         o.region = {{5, 3, 40, 30}};
         o.sampler = SamplerKind::independent;
       }}};
  for (const auto& [name, change] : changes) {
    SCOPED_TRACE(name);
    RenderOptions o = options();
    change(o);
    // No point light, spot light or sun is found by BSDF sampling.
    if (o.direct == DirectLight::bsdf) o.light_groups = {{"panel", {"panel"}}, {"sky", {"environment"}}};
    expect_sum(rendered(scene, o), o.direct == DirectLight::bsdf ? 3 : 6);
  }
}

TEST_F(LightLayers, ChangeNoOther) {
  GATELIGHT_NEEDS_DENOISER();
  RenderOptions o = options();
  o.clamp = 2.0f;
  testing::denoise(o);
  const Picture grouped = rendered(scene, o);
  o.light_groups.clear();
  const Picture plain = rendered(scene, o);
  EXPECT_TRUE(groups_of(plain).empty());
  for (const Layer& layer : plain.layers)
    EXPECT_EQ(layer.values, grouped.find(layer.name)->values) << layer.name;
}

TEST_F(LightLayers, ASkysOwnSunIsTheEnvironment) {
  scene.lights.clear();
  for (scene::Material& material : scene.materials) material.emission.setZero();
  for (const float size : {0.0f, 0.53f}) {
    RenderOptions o = options();
    o.environment = {};
    o.environment.sky = SkyOptions{.sun_size_degrees = size};
    o.light_groups = {{"day", {"environment"}}};
    const Picture picture = rendered(scene, o);
    expect_sum(picture, 1);
    EXPECT_EQ(groups_of(picture)[0]->values, picture.find("raw")->values);
  }
}

TEST_F(LightLayers, UnlitColoursAreInTheRest) {
  scene.materials[1].unlit = true;  // the wall
  for (scene::Material& material : scene.materials) {
    if (material.name == "glow") material.emission.setZero();
  }
  const Picture picture = rendered(scene, options());
  expect_sum(picture, 6);
  EXPECT_EQ(groups_of(picture)[5]->name, "light-rest");
}

TEST_F(LightLayers, AreRefusedByIntegratorsThatDoNotSeparateLights) {
  for (const Integrator integrator : {Integrator::nrc, Integrator::nao, Integrator::ao}) {
    RenderOptions o = options();
    o.integrator = integrator;
    expect_refused_parts<BadOption>([&] { Renderer(scene, o); },
                                    {"light-groups", "", enum_name(integrator), "`integrator` path"});
  }
}

}  // namespace
}  // namespace gatelight::renderer

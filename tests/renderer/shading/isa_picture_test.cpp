// A picture has the same bits whatever instruction set shades it. Embree keeps its own.

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "base/simd/isa.h"
#include "renderer/render.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {
using testing::SceneBuilder;

/// Sets a variable of the environment for a while.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

SceneBuilder everything() {
  SceneBuilder builder;
  scene::Material varnish;
  varnish.base_color = Color(0.7f, 0.4f, 0.2f);
  varnish.roughness = 0.6f;
  varnish.clearcoat = 1.0f;
  varnish.clearcoat_roughness = 0.1f;
  builder.quad(builder.material(varnish), Vec3(-3, 0, 3), Vec3(6, 0, 0), Vec3(0, 0, -6));
  scene::Material cloth;
  cloth.sheen_color = Color(0.5f, 0.8f, 0.3f);
  cloth.sheen_roughness = 0.5f;
  builder.sphere(builder.material(cloth), Vec3(-0.8f, 0.6f, 0), 0.6f, 16, true);
  scene::Material pane;
  pane.transmission = 1.0f;
  pane.roughness = 0.2f;
  pane.double_sided = true;
  builder.quad(builder.material(pane), Vec3(0.2f, 0.0f, 0.8f), Vec3(1.2f, 0, 0), Vec3(0, 1.2f, 0));
  scene::Material metal;
  metal.metallic = 1.0f;
  metal.roughness = 0.0f;
  builder.sphere(builder.material(metal), Vec3(0.9f, 0.5f, -0.5f), 0.5f, 16, true);
  const int lamp = builder.material(SceneBuilder::lambert(Color::Zero(), Color(8, 7, 6)));
  for (int i = 0; i < 12; ++i) {
    const Vec3 p(-2.0f + 0.4f * static_cast<float>(i), 2.0f, -1.0f);
    builder.box(lamp, p, p + Vec3::Constant(0.1f));
  }
  scene::PunctualLight sun;
  sun.type = scene::LightType::directional;
  sun.direction = Vec3(0.3f, -1.0f, 0.2f).normalized();
  sun.intensity = Color(1, 1, 1);
  scene::PunctualLight spot;
  spot.type = scene::LightType::spot;
  spot.position = Vec3(0, 3, 2);
  spot.direction = Vec3(0, -1, -0.5f).normalized();
  spot.intensity = Color(5, 5, 9);
  spot.cos_inner = 0.95f;
  spot.cos_outer = 0.7f;
  builder.scene().lights = {sun, spot};
  return builder;
}

TEST(ShadingIsa, APictureHasTheSameBitsOnEveryInstructionSet) {
  SceneBuilder builder = everything();
  for (const SamplerKind sampler : {SamplerKind::sobol, SamplerKind::independent}) {
    RenderOptions options;
    options.width = 64;
    options.height = 48;
    options.spp = 6;
    options.threads = 2;
    options.sampler = sampler;
    options.environment.constant = Color(0.2f, 0.3f, 0.5f);
    options.aovs = {Aov::albedo};
    options.light_groups = {{"lamps", {"*"}}, {"sky", {"environment"}}};
    std::optional<Picture> first;
    for (const simd::Isa isa : simd::available_isas()) {
      const Variable chosen("GATELIGHT_ISA", std::string(simd::isa_name(isa)));
      const Picture picture = Renderer(builder.scene(), options).render();
      if (!first) {
        first = picture;
        continue;
      }
      ASSERT_EQ(picture.layers.size(), first->layers.size());
      for (std::size_t l = 0; l < picture.layers.size(); ++l) {
        EXPECT_EQ(picture.layers[l].values, first->layers[l].values) << simd::isa_name(isa);
      }
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer

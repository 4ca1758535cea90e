// A picture has the same bits whatever instruction set shades it. Embree keeps its own.

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "base/simd/isa.h"
#include "renderer/render.h"
#include "tests/support/environment_variable.h"
#include "tests/support/materials.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {
using testing::SceneBuilder;

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
  builder.sphere(builder.material(testing::mirror(1.0f)), Vec3(0.9f, 0.5f, -0.5f), 0.5f, 16, true);
  const int lamp = builder.material(SceneBuilder::lambert(Color::Zero(), Color(8, 7, 6)));
  for (int i = 0; i < 12; ++i) {
    const Vec3 p(-2.0f + 0.4f * static_cast<float>(i), 2.0f, -1.0f);
    builder.box(lamp, p, p + Vec3::Constant(0.1f));
  }
  builder.scene().lights = {testing::sun(Vec3(0.3f, -1.0f, 0.2f)),
                            {.type = scene::LightType::spot,
                             .intensity = Color(5, 5, 9),
                             .position = Vec3(0, 3, 2),
                             .direction = Vec3(0, -1, -0.5f).normalized(),
                             .cos_inner = 0.95f,
                             .cos_outer = 0.7f}};
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
      const tests::EnvironmentVariable chosen("GATELIGHT_ISA", std::string(simd::isa_name(isa)));
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

// The golden pictures reject small defects. Each is a change of the scene or of the options that imitates a
// wrong renderer; without them the comparison might accept anything.

#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>
#include <string>

#include "renderer/image/image_read.h"
#include "tests/renderer/golden/golden_cases.h"
#include "tests/renderer/golden/golden_compare.h"
#include "tests/support/statistics.h"

namespace gatelight::testing {
namespace {

using renderer::RenderOptions;
using scene::Material;
using scene::Scene;

struct Defect {
  std::string name;
  std::string golden;
  std::function<void(Scene&, RenderOptions&)> apply;
};

Material& material(Scene& scene, const std::string& name) {
  for (Material& m : scene.materials) {
    if (m.name == name) return m;
  }
  throw std::out_of_range("no material is called " + name);
}

std::vector<Defect> defects() {
  return {
      {"AlbedoFivePercentHigher", "cornell-box",
       [](Scene& s, RenderOptions&) { material(s, "white").base_color *= 1.05f; }},
      {"LastBounceMissing", "cornell-box", [](Scene&, RenderOptions& o) { o.max_depth = 4; }},
      {"AlbedoOnePercentLower", "furnace",
       [](Scene& s, RenderOptions&) { material(s, "furnace").base_color *= 0.99f; }},
      {"FillLightMissing", "living-room",
       [](Scene& s, RenderOptions&) { material(s, "evening light").emission = Color::Zero(); }},
      {"SpotMissing", "material-grid",
       [](Scene& s, RenderOptions&) {
         std::erase_if(s.lights, [](const auto& light) { return light.type == scene::LightType::spot; });
       }},
      {"TextureSeamMoved", "material-grid",
       [](Scene& s, RenderOptions&) { material(s, "backdrop").base_color_texture.transform(0, 2) += 0.03f; }},
      {"NormalMapMissing", "material-grid",
       [](Scene& s, RenderOptions&) { material(s, "woven silver").normal_scale = 0.0f; }},
      {"IndexOfRefraction", "material-grid",
       [](Scene& s, RenderOptions&) { material(s, "green glass").ior = 1.2f; }},
      {"AbsorptionMissing", "material-grid",
       [](Scene& s, RenderOptions&) { material(s, "green glass").attenuation_distance = kInfinity; }},
      {"CoatMissing", "material-grid",
       [](Scene& s, RenderOptions&) { material(s, "red lacquer").clearcoat = 0.0f; }},
      {"SkyTurnedByTenDegrees", "material-grid",
       [](Scene&, RenderOptions& o) { o.environment.rotation_degrees = 10.0f; }},
      {"GroovesMissing", "turntable",
       [](Scene& s, RenderOptions&) {
         for (const char* name : {"record", "platter"}) material(s, name).anisotropy = 0.0f;
       }},
      {"ClothKeepsTheLightIn", "turntable",
       [](Scene& s, RenderOptions&) { material(s, "lampshade").diffuse_transmission = 0.0f; }},
      {"FilmMissing", "turntable",
       [](Scene& s, RenderOptions&) {
         for (const char* name : {"soap bubble", "beetle"}) material(s, name).iridescence = 0.0f;
       }},
      {"WindowElsewhere", "turntable",
       [](Scene& s, RenderOptions&) { s.image_light->rotation.setIdentity(); }},
      {"PrismKeepsColoursTogether", "turntable-prism",
       [](Scene& s, RenderOptions&) { material(s, "prism").dispersion = 0.0f; }},
      {"IceInWaterIsIceInAir", "iced-water",
       [](Scene& s, RenderOptions&) {
         for (scene::Instance& instance : s.instances) instance.placement = -1;
       }},
      {"WaterIsStrongerThanTheGlass", "iced-water",
       [](Scene& s, RenderOptions&) {
         for (scene::Instance& instance : s.instances)
           instance.dielectric_priority = instance.name == "water" ? 2.0f : 0.0f;
       }},
      {"OcclusionDistanceFifthLonger", "teapot-ao", [](Scene&, RenderOptions& o) { o.ao_distance *= 1.2f; }},
  };
}

class DefectsGolden : public ::testing::TestWithParam<Defect> {};

TEST_P(DefectsGolden, AreRejected) {
  const Defect& defect = GetParam();
  const GoldenCase& c = golden_case(defect.golden);
  const renderer::Picture reference = renderer::read_image(golden_reference(c));
  Scene scene = load_golden_scene(c);
  RenderOptions options = c.options;
  defect.apply(scene, options);
  const renderer::Picture image = render_golden(c, scene, options);
  const int reference_spp = std::stoi(reference.metadata.at("spp"));
  const GoldenVerdict verdict = compare_with_reference({image, options.spp}, {reference, reference_spp},
                                                       sidak(1e-4, golden_cases().size()));
  EXPECT_FALSE(verdict.agrees) << "not detected:\n" << verdict.report;
}

INSTANTIATE_TEST_SUITE_P(All, DefectsGolden, ::testing::ValuesIn(defects()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace gatelight::testing

// Scenes without light and views that show nothing: the pictures and the warnings.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "renderer/render.h"
#include "tests/support/messages.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {

namespace {

using testing::SceneBuilder;
using tests::expect_messages;

struct Seen {
  std::vector<std::string> warnings;
  float brightest = 0.0f;
};

Seen render(const scene::Scene& s, RenderOptions options) {
  options.width = options.height = 16;
  options.spp = 4;
  Renderer renderer(s, options);
  const Picture picture = renderer.render();
  return {renderer.statistics().warnings,
          *std::max_element(picture.layers[0].values.begin(), picture.layers[0].values.end())};
}

SceneBuilder clay_box() {
  SceneBuilder builder;
  builder.box(builder.material(SceneBuilder::lambert(Color::Constant(0.5f))), Vec3(-1, -1, -1),
              Vec3(1, 1, 1));
  return builder;
}

RenderOptions from(const Vec3& eye) {
  RenderOptions options;
  options.camera.look_at = LookAt{eye, Vec3(0, 0, 0), Vec3(0, 1, 0)};
  return options;
}

TEST(DarkScenes, GetASkyOrStayBlackWithAWarning) {
  const scene::Scene box = clay_box().scene();
  RenderOptions options = from(Vec3(1, 2, 4));
  Seen seen = render(box, options);
  EXPECT_EQ(seen.brightest, 0.0f);
  expect_messages(seen.warnings, {{"built.glb", "no light", "none", "black"}});
  options.environment.automatic = true;
  seen = render(box, options);
  EXPECT_GT(seen.brightest, 0.2f);
  expect_messages(seen.warnings, {{"built.glb", "no light", "soft sky", "`environment`"}});
  options.integrator = Integrator::ao;
  EXPECT_TRUE(render(box, options).warnings.empty());
  options.integrator = Integrator::path;
  scene::Scene lit = box;
  lit.lights.emplace_back();
  lit.lights[0].intensity = Color::Zero();
  seen = render(lit, options);
  EXPECT_EQ(seen.brightest, 0.0f) << "a light of the file that is dark is the file's choice";
  EXPECT_TRUE(seen.warnings.empty());
}

TEST(DarkScenes, AFileWithoutACameraGivesAWarning) {
  RenderOptions options;
  options.environment.constant = Color::Ones();
  scene::Scene box = clay_box().scene();
  expect_messages(render(box, options).warnings, {{"built.glb", "no camera", "`eye`", "`target`"}});
  box.cameras.emplace_back().transform.translation() = Vec3(0, 0, 5);
  EXPECT_TRUE(render(box, options).warnings.empty());
  scene::Scene empty;
  empty.path = "empty.glb";
  expect_messages(render(empty, options).warnings, {{"empty.glb", "no triangles"}});
}

TEST(DarkScenes, ACameraThatSeesNothingOrBackFacesGivesAWarning) {
  RenderOptions options = from(Vec3(0.1f, 0.2f, 0.3f));
  options.environment.constant = Color::Ones();
  const scene::Scene box = clay_box().scene();
  expect_messages(render(box, options).warnings, {{"built.glb", "inside", "100 %", "back faces"}});
  options.camera.look_at = LookAt{Vec3(0, 0, 5), Vec3(0, 0, 9), Vec3(0, 1, 0)};
  expect_messages(render(box, options).warnings, {{"built.glb", "sees nothing", "100 %"}});
  // The grid of rays may pass what is small.
  options.camera.look_at = LookAt{Vec3(0, 0, 3000), Vec3(0, 0, 0), Vec3(0, 1, 0)};
  EXPECT_TRUE(render(box, options).warnings.empty());
  // A view from inside a double-sided object or glass gives no warning.
  options = from(Vec3(0.1f, 0.2f, 0.3f));
  options.environment.constant = Color::Ones();
  scene::Scene two_sided = box;
  two_sided.materials[0].double_sided = true;
  EXPECT_TRUE(render(two_sided, options).warnings.empty());
}

}  // namespace
}  // namespace gatelight::renderer

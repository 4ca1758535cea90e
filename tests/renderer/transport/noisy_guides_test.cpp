#include "renderer/transport/noisy_guides.h"

#include <gtest/gtest.h>

#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;

constexpr PixelRect kPicture{0, 0, 256, 192};

/// A wall that fills the view, and in front of its left upper quarter a small pane of the material.
scene::Scene wall_with(const scene::Material& material) {
  SceneBuilder builder;
  builder.quad(builder.material(SceneBuilder::lambert(Color::Constant(0.5f))), Vec3(-8, -6, -4),
               Vec3(16, 0, 0), Vec3(0, 12, 0));
  builder.quad(builder.material(material), Vec3(-0.8f, 0.4f, -2), Vec3(0.4f, 0, 0), Vec3(0, 0.2f, 0));
  return builder.scene();
}

PixelRect found(const scene::Scene& scene, const PixelRect& region = kPicture, float lens_radius = 0.0f,
                float fog = 0.0f) {
  WorldOptions options;
  if (fog > 0.0f) options.environment.fog = FogOptions{fog};
  const World world(scene, options);
  View view;
  view.vertical_fov = 1.0f;
  view.lens_radius = lens_radius;
  view.focus_distance = 4.0f;
  return noisy_guides(world, Camera(view, kPicture.x1, kPicture.y1), region, {});
}

bool is_empty(const PixelRect& rect) {
  return rect.width() <= 0 || rect.height() <= 0;
}

TEST(NoisyGuides, AreAroundWhatIsSeenThrough) {
  scene::Material glass;
  glass.metallic = 0.0f;
  glass.roughness = 0.0f;
  glass.transmission = 1.0f;
  scene::Material veil = SceneBuilder::lambert(Color::Constant(0.5f));
  veil.alpha_mode = scene::AlphaMode::blend;
  veil.base_alpha = 0.5f;
  scene::Material lace = veil;
  lace.alpha_mode = scene::AlphaMode::mask;
  // The pane is within 53..96 x 26..62, with a tile around it.
  for (const scene::Material& material : {glass, veil, lace}) {
    const PixelRect rect = found(wall_with(material));
    EXPECT_TRUE(rect.x0 <= 53 && rect.y0 <= 62 && rect.x1 >= 90 && rect.y1 >= 62)
        << rect.x0 << " " << rect.y1;
    EXPECT_TRUE(rect.x1 <= 128 && rect.y1 <= 96) << rect.x1 << " " << rect.y1;
    EXPECT_TRUE(is_empty(found(wall_with(material), {160, 100, 256, 192})));
  }
  EXPECT_TRUE(is_empty(found(wall_with(SceneBuilder::lambert(Color::Constant(0.8f))))));
}

TEST(NoisyGuides, AreEverywhereWithALensOrFog) {
  const scene::Scene wall = wall_with(SceneBuilder::lambert(Color::Constant(0.8f)));
  EXPECT_EQ(found(wall, kPicture, 0.1f), kPicture);
  EXPECT_EQ(found(wall, kPicture, 0.0f, 0.5f), kPicture);
}

}  // namespace
}  // namespace gatelight::renderer

// Several shadow catchers: each catches the shadows of objects, but not those of the others.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "renderer/film/camera.h"
#include "renderer/film/camera_choice.h"
#include "renderer/render.h"
#include "tests/support/materials.h"
#include "tests/support/messages.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;

constexpr int kCornerWidth = 64, kCornerHeight = 48;

/// A floor and a wall to the left of it that catch shadows, and a cube above the floor.
struct CatchingCorner : SceneBuilder {
  RenderOptions options;

  explicit CatchingCorner(const Vec3& sun) {
    const int matte = material(lambert(Color::Constant(0.5f)));
    quad(matte, Vec3(-2, 0, 4), Vec3(8, 0, 0), Vec3(0, 0, -8));
    quad(matte, Vec3(-2, 0, 4), Vec3(0, 0, -8), Vec3(0, 3, 0));
    box(matte, Vec3(-0.5f, 1, -0.5f), Vec3(0.5f, 2, 0.5f));
    scene().instances[0].name = "floor";
    scene().instances[1].name = "wall";
    for (const std::size_t i : {0u, 1u}) scene().instances[i].visibility.shadow_catcher = true;
    scene().lights = {testing::sun(sun)};
    options.width = kCornerWidth;
    options.height = kCornerHeight;
    options.spp = 16;
    options.background.kind = BackgroundOptions::Kind::transparent;
    options.camera.look_at = LookAt{Vec3(2, 4, 7), Vec3(-0.5f, 0.5f, 0), Vec3(0, 1, 0)};
  }
  Picture picture() { return Renderer(scene(), options).render(); }
  /// Of the pixel that shows a point.
  const float* values_at(const Picture& picture, const Vec3& point) {
    const Camera camera(
        choose_camera(scene(), options.camera, static_cast<float>(kCornerWidth) / kCornerHeight),
        kCornerWidth, kCornerHeight);
    const Vec2 place = camera.pixel_of(point).value();
    const int x = static_cast<int>(place.x()), y = static_cast<int>(place.y());
    const Layer& layer = picture.layers[0];
    return &layer.values[layer.channels.size() * static_cast<std::size_t>(y * kCornerWidth + x)];
  }
  float alpha(const Picture& picture, const Vec3& point) { return values_at(picture, point)[3]; }
};

TEST(ShadowCatchers, AllCatchTheShadowOfAnObject) {
  CatchingCorner corner(Vec3(-1, -1, 0));
  const Picture picture = corner.picture();
  EXPECT_FLOAT_EQ(corner.alpha(picture, Vec3(-1.2f, 0, 0)), 1.0f);
  EXPECT_FLOAT_EQ(corner.alpha(picture, Vec3(-2, 0.25f, 0)), 1.0f);
  EXPECT_FLOAT_EQ(corner.alpha(picture, Vec3(-1.2f, 0, 1.5f)), 0.0f);
  EXPECT_FLOAT_EQ(corner.alpha(picture, Vec3(-2, 1, 0)), 0.0f);
}

TEST(ShadowCatchers, DoNotShadeEachOther) {
  // From behind the wall.
  for (const bool object : {true, false}) {
    CatchingCorner corner(Vec3(1, -1, 0));
    if (!object) corner.scene().instances[1].visibility.shadow_catcher = false;
    const Picture picture = corner.picture();
    EXPECT_FLOAT_EQ(corner.alpha(picture, Vec3(1.5f, 0, 0)), 1.0f);
    EXPECT_FLOAT_EQ(corner.alpha(picture, Vec3(-1.2f, 0, 1.5f)), object ? 0.0f : 1.0f);
    EXPECT_FLOAT_EQ(corner.alpha(picture, Vec3(2.5f, 0, 1.5f)), 0.0f);
  }
}

TEST(ShadowCatchers, MayBeNamedByOptionsAndFlags) {
  CatchingCorner flags(Vec3(-1, -1, 0));
  const std::vector<float> expected = flags.picture().layers[0].values;
  for (const char* names : {"wall", "floor;wall", "wa*;fl*"}) {
    CatchingCorner corner(Vec3(-1, -1, 0));
    corner.scene().instances[1].visibility.shadow_catcher = false;
    if (names[0] != 'w' || names[1] == 'a') corner.options.background.shadow_catcher = names;
    EXPECT_EQ(corner.picture().layers[0].values, expected) << names;
  }
}

TEST(ShadowCatchers, WithoutAnAlphaAreShownWithAWarning) {
  CatchingCorner corner(Vec3(-1, -1, 0));
  corner.options.background.kind = BackgroundOptions::Kind::scene;
  Renderer renderer(corner.scene(), corner.options);
  tests::expect_messages(renderer.statistics().warnings, {{"built.glb", "floor", "background"}});
  const Picture picture = renderer.render();
  const float lit = corner.values_at(picture, Vec3(1, 0, 1.5f))[0];
  EXPECT_GT(lit, 0.1f);
  EXPECT_LT(corner.values_at(picture, Vec3(-1.2f, 0, 0))[0], 0.5f * lit);
}

}  // namespace
}  // namespace gatelight::renderer

// Points of pixels, and their places a frame ago, against closed forms.

#include "renderer/temporal/visible_points.h"

#include <gtest/gtest.h>

#include "renderer/sampling/warp.h"
#include "tests/renderer/cache/small_worlds.h"
#include "tests/support/materials.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;
using testing::view_from;

constexpr int kViewWidth = 64, kViewHeight = 48;
constexpr PixelRect kViewRect{0, 0, kViewWidth, kViewHeight};

TEST(CameraPixels, AreTheInverseOfRays) {
  View view(view_from(Vec3(1, 2, 3), Vec3(0.5f, 0, -1)));
  View parallel = view;
  parallel.orthographic = true;
  parallel.half_height = 2.0f;
  View panorama = view;
  panorama.panorama = true;
  for (const View& v : {view, parallel, panorama}) {
    const Camera camera(v, kViewWidth, kViewHeight);
    for (const Vec2& pixel : {Vec2(0.5f, 0.5f), Vec2(40.25f, 13.0f), Vec2(63.0f, 47.5f)}) {
      const Ray ray = camera.ray(pixel.x(), pixel.y()).ray;
      const std::optional<Vec2> found = camera.pixel_of(ray.origin + 5.0f * ray.direction);
      ASSERT_TRUE(found);
      EXPECT_LT((*found - pixel).norm(), 1e-3f);
    }
  }
  const Camera camera(view, kViewWidth, kViewHeight);
  EXPECT_FALSE(camera.pixel_of(Vec3(2, 4, 9))) << "behind it";
}

/// A quad that moves, before a wall. The quad's transform is `at`.
SceneBuilder moving_quad(const Affine& at) {
  SceneBuilder builder;
  const int matte = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  builder.quad(matte, Vec3(-9, -9, -4), Vec3(18, 0, 0), Vec3(0, 18, 0));
  builder.quad(matte, Vec3(-1, -1, 0), Vec3(2, 0, 0), Vec3(0, 2, 0));
  scene::Instance& quad = builder.scene().instances.back();
  quad.baked = false;
  quad.moves = true;
  quad.transform = at;
  builder.scene().motion.instances = true;
  builder.scene().cameras.push_back(view_from(Vec3(0, 0, 4), Vec3::Zero()));
  return builder;
}

/// The points of a scene, seen as it was before by the same camera.
struct Followed {
  Followed(scene::Scene& present, scene::Scene& earlier)
      : world(present), camera(present.cameras[0], kViewWidth, kViewHeight) {
    const PreviousView view{SceneSnapshot(earlier), camera};
    points = trace_visible_points(world, camera, kViewRect, &view);
  }

  World world;
  Camera camera;
  VisiblePoints points;
};

TEST(VisiblePoints, FollowWhatMoves) {
  Affine before = Affine::Identity(), now = Affine::Identity();
  before.translation() = Vec3(-0.5f, 0.25f, 0.0f);
  before.rotate(Eigen::AngleAxisf(0.2f, Vec3::UnitZ()));
  now.translation() = Vec3(0.3f, 0.0f, 0.5f);
  SceneBuilder earlier = moving_quad(before), present = moving_quad(now);
  const Followed seen(present.scene(), earlier.scene());
  const VisiblePoints& points = seen.points;
  int moved = 0;
  for (std::size_t i = 0; i < points.now.size(); ++i) {
    const VisiblePoint& point = points.now[i];
    ASSERT_TRUE(point.hit);
    ASSERT_TRUE(points.earlier[i]);
    const Vec3 expected =
        point.hit.instance == 1 ? Vec3(before * now.inverse() * point.position) : point.position;
    moved += point.hit.instance == 1 ? 1 : 0;
    EXPECT_LT((points.earlier[i]->position - expected).norm(), 1e-4f);
    EXPECT_LT((points.earlier[i]->pixel - *seen.camera.pixel_of(expected)).norm(), 1e-2f);
    EXPECT_NEAR(points.earlier[i]->normal.z(), 1.0f, 1e-5f);
  }
  EXPECT_GT(moved, 300);
}

TEST(VisiblePoints, HiddenThingsHaveNoEarlierPlace) {
  SceneBuilder earlier = moving_quad(Affine::Identity()), present = moving_quad(Affine::Identity());
  earlier.scene().instances[1].hidden = true;
  const VisiblePoints points = Followed(present.scene(), earlier.scene()).points;
  for (std::size_t i = 0; i < points.now.size(); ++i)
    EXPECT_EQ(points.earlier[i].has_value(), points.now[i].hit.instance == 0);
}

TEST(VisiblePoints, InAMirrorAreWhereTheImageWas) {
  SceneBuilder builder;
  builder.quad(builder.material(testing::mirror(1.0f)), Vec3(-9, -9, 0), Vec3(18, 0, 0), Vec3(0, 18, 0));
  const int matte = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  builder.quad(matte, Vec3(9, -9, 9), Vec3(-18, 0, 0), Vec3(0, 18, 0));
  const World world(builder.scene());
  const Camera camera(view_from(Vec3(0, 0, 4), Vec3::Zero()), kViewWidth, kViewHeight);
  const Camera before(view_from(Vec3(0.5f, 0, 4), Vec3(0.5f, 0, 0)), kViewWidth, kViewHeight);
  const PreviousView view{SceneSnapshot(builder.scene()), before};
  const VisiblePoints points = trace_visible_points(world, camera, kViewRect, &view);
  const std::size_t middle = kViewRect.index(kViewWidth / 2, kViewHeight / 2);
  ASSERT_EQ(points.now[middle].hit.instance, 1u);
  ASSERT_TRUE(points.earlier[middle]);
  const Vec3& seen = points.now[middle].position;
  EXPECT_NEAR(seen.z(), 9.0f, 1e-4f);
  EXPECT_LT((points.earlier[middle]->position - seen).norm(), 1e-4f);
  const Vec3 image(seen.x(), seen.y(), -9.0f);
  EXPECT_LT((points.earlier[middle]->pixel - *before.pixel_of(image)).norm(), 1e-2f);
  // 13 m away, the camera's half a metre is 2.1 pixels.
  EXPECT_NEAR(points.earlier[middle]->pixel.x() - (kViewWidth / 2 + 0.5f), -1.91f, 0.05f);
}

/// A wall behind a half-transparent pane on the left, and beside a mirror on the right that shows it. Its
/// materials change with the time.
struct ChangingWall {
  ChangingWall() {
    scene::Scene& scene = builder.scene();
    wall = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
    scene::Material pane = SceneBuilder::lambert(Color::Constant(0.8f));
    pane.alpha_mode = scene::AlphaMode::blend;
    pane.base_alpha = 0.5f;
    veil = builder.material(pane);
    builder.quad(wall, Vec3(-9, -9, -4), Vec3(18, 0, 0), Vec3(0, 18, 0));
    builder.quad(veil, Vec3(-3, -3, 0), Vec3(2, 0, 0), Vec3(0, 6, 0));
    builder.quad(builder.material(testing::mirror(1.0f)), Vec3(2, -3, 2), Vec3(0, 0, -4), Vec3(0, 6, 0));
    scene.motion.materials = true;
    before = scene.materials;
  }

  /// The changes since `before` by pixel, in the middle row.
  std::vector<float> changes() {
    scene::Scene& scene = builder.scene();
    std::swap(scene.materials, before);
    const PreviousView view{SceneSnapshot(scene), camera};
    std::swap(scene.materials, before);
    const World world(scene);
    const VisiblePoints points = trace_visible_points(world, camera, kViewRect, &view);
    const auto row = points.changes.begin() + kViewWidth * (kViewHeight / 2);
    return {row, row + kViewWidth};
  }
  scene::Material& material(int i) { return builder.scene().materials[static_cast<std::size_t>(i)]; }

  SceneBuilder builder;
  std::vector<scene::Material> before;
  int wall = 0, veil = 0;
  Camera camera{view_from(Vec3(0, 0, 4), Vec3::Zero()), kViewWidth, kViewHeight};
};

constexpr std::size_t kLeftPixel = 4, kMiddlePixel = kViewWidth / 2, kRightPixel = kViewWidth - 5;

TEST(VisiblePoints, OfTheSameMaterialHaveNotChanged) {
  for (const float change : ChangingWall().changes()) EXPECT_EQ(change, 0.0f);
  SceneBuilder still = moving_quad(Affine::Identity());
  EXPECT_TRUE(Followed(still.scene(), still.scene()).points.changes.empty());
}

TEST(VisiblePoints, TellTheChangeOfWhatThePixelShows) {
  ChangingWall colored;
  colored.material(colored.wall).base_color = Color(0.5f, 0.4f, 0.5f);
  const std::vector<float> color = colored.changes();
  EXPECT_NEAR(color[kMiddlePixel], 0.2f, 1e-5f);
  EXPECT_NEAR(color[kLeftPixel], 0.1f, 1e-5f) << "behind a pane of alpha 0.5";
  EXPECT_NEAR(color[kRightPixel], 0.2f, 1e-5f) << "in a mirror";

  ChangingWall faded;
  faded.material(faded.veil).base_alpha = 0.4f;
  const std::vector<float> alpha = faded.changes();
  EXPECT_EQ(alpha[kMiddlePixel], 0.0f);
  EXPECT_NEAR(alpha[kLeftPixel], 0.1f, 1e-5f);

  ChangingWall clear;
  clear.material(clear.veil).base_alpha = 0.0f;
  EXPECT_NEAR(clear.changes()[kLeftPixel], 0.5f, 1e-5f) << "also the last of it";

  const auto change_of = [](auto&& change) {
    ChangingWall changing;
    change(changing.material(changing.wall));
    return changing.changes()[kMiddlePixel];
  };
  EXPECT_EQ(change_of([](scene::Material& m) { m.emission = Color(0.1f, 0.0f, 0.0f); }), 1.0f);
  EXPECT_NEAR(change_of([](scene::Material& m) { m.roughness = 0.9f; }), 0.0f, 1e-5f) << "it is matte";
  EXPECT_NEAR(change_of([](scene::Material& m) { m.metallic = 0.1f; }), 0.21f, 0.02f);
  EXPECT_EQ(change_of([](scene::Material& m) { m.unlit = true; }), 1.0f);
}

}  // namespace
}  // namespace gatelight::renderer

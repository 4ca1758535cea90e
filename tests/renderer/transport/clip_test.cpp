// Cameras that see only what is between two planes, or two spheres.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "renderer/render.h"
#include "tests/support/materials.h"
#include "tests/support/messages.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;

/// WallsInARow of the radiances 2, 4 and 6, that many metres before the camera, in a sky of radiance 1.
struct WallsInARow : SceneBuilder {
  RenderOptions options;

  explicit WallsInARow(Projection projection) {
    for (const float distance : {2.0f, 4.0f, 6.0f}) {
      const int lamp = material(lambert(Color::Zero(), Color::Constant(distance)));
      if (projection == Projection::panorama) {
        sphere(lamp, Vec3::Zero(), distance, 64, false);
        for (auto& t : scene().meshes.back().triangles) std::swap(t[1], t[2]);
      } else {
        quad(lamp, Vec3(-90, -90, -distance), Vec3(180, 0, 0), Vec3(0, 180, 0));
      }
    }
    options.width = options.height = 16;
    options.spp = 4;
    options.filter = PixelFilter::box;
    options.filter_width = 1e-3f;
    options.environment.constant = Color::Ones();
    options.aovs = {Aov::depth};
    options.camera.look_at = LookAt{Vec3::Zero(), Vec3(0, 0, -1), Vec3(0, 1, 0)};
    options.camera.projection = projection;
  }
  Picture picture() { return Renderer(scene(), options).render(); }
  void expect_radiance(float expected) {
    const Picture seen = picture();
    for (const float value : seen.layers[0].values) ASSERT_EQ(value, expected);
  }
};

class Clipped : public ::testing::TestWithParam<Projection> {};

TEST_P(Clipped, ShowsWhatIsBetweenNearAndFar) {
  struct Case {
    Clip clip;
    float seen;
  };
  for (const auto& [clip, seen] :
       {Case{{}, 2.0f}, Case{{.near = 3.0f}, 4.0f}, Case{{.near = 4.5f}, 6.0f}, Case{{.near = 7.0f}, 1.0f},
        Case{{.far = 1.5f}, 1.0f}, Case{{.near = 2.5f, .far = 3.5f}, 1.0f},
        Case{{.near = 3.0f, .far = 4.5f}, 4.0f}}) {
    WallsInARow walls(GetParam());
    walls.options.camera.clip = clip;
    SCOPED_TRACE(::testing::Message() << clip.near << " to " << clip.far);
    walls.expect_radiance(seen);
  }
}

TEST_P(Clipped, DepthIsTheDistanceFromTheEye) {
  WallsInARow plain(GetParam()), clipped(GetParam());
  for (WallsInARow* walls : {&plain, &clipped}) walls->options.camera.look_at->eye = Vec3(0.1f, 0.2f, 0);
  plain.scene().instances.erase(plain.scene().instances.begin());
  clipped.options.camera.clip = {3.0f, 5.0f};
  const Picture a = plain.picture(), b = clipped.picture();
  const std::vector<float>&expected = a.find("depth")->values, &seen = b.find("depth")->values;
  float largest = 0.0f;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_NEAR(seen[i], expected[i], 1e-4f);
    largest = std::max(largest, seen[i]);
  }
  EXPECT_GT(largest, GetParam() == Projection::orthographic ? 3.99f : 4.05f);
}

TEST_P(Clipped, FarCountsTheWayThroughPanes) {
  for (const float far : {3.5f, 5.0f}) {
    WallsInARow walls(GetParam());
    walls.scene().instances.erase(walls.scene().instances.begin());
    scene::Material pane = SceneBuilder::clear_glass();
    pane.ior = 1.0f;
    walls.sphere(walls.material(pane), Vec3::Zero(), 1.5f, 64, false);
    walls.options.camera.clip = {0.5f, far};
    walls.expect_radiance(far == 3.5f ? 1.0f : 4.0f);
  }
}

INSTANTIATE_TEST_SUITE_P(Projections, Clipped,
                         ::testing::Values(Projection::perspective, Projection::orthographic,
                                           Projection::panorama));

TEST(Clip, ConcernsOnlyRaysOfTheCamera) {
  // A mirror four metres away shows a lamp behind the camera, and the shadow of an object before the near
  // plane is on the wall.
  const LookAt forward{Vec3::Zero(), Vec3(0, 0, -1), Vec3(0, 1, 0)};
  for (const bool mirror : {true, false}) {
    SceneBuilder builder;
    builder.quad(builder.material(mirror ? testing::mirror() : SceneBuilder::lambert(Color::Ones())),
                 Vec3(-9, -9, -4), Vec3(18, 0, 0), Vec3(0, 18, 0));
    builder.quad(builder.material(SceneBuilder::lambert(Color::Zero())), Vec3(0, -9, -1), Vec3(9, 0, 0),
                 Vec3(0, 18, 0));
    builder.quad(builder.material(SceneBuilder::lambert(Color::Zero(), Color::Constant(5.0f))),
                 Vec3(-9, -9, 2), Vec3(0, 18, 0), Vec3(18, 0, 0));
    RenderOptions options;
    options.width = 8;
    options.height = 4;
    options.spp = 4;
    options.filter = PixelFilter::box;
    options.camera.look_at = forward;
    options.camera.projection = Projection::orthographic;
    options.camera.view_height = 1.0f;
    options.camera.clip = {1.5f, 4.5f};
    if (!mirror) {
      builder.scene().instances.pop_back();
      builder.scene().lights = {testing::sun(Vec3(0, 0, -1))};
    }
    const Picture picture = Renderer(builder.scene(), options).render();
    EXPECT_NEAR(picture.layers[0].values.front(), mirror ? 5.0f * 0.9f : kInvPi, 1e-4f);
    EXPECT_EQ(picture.layers[0].values[3 * 7], 0.0f);
  }
}

TEST(Clip, OfNothingIsRefused) {
  for (const Clip& clip :
       {Clip{-1.0f, 5.0f}, Clip{2.0f, 2.0f}, Clip{3.0f, 1.0f}, Clip{std::nanf(""), 1.0f}}) {
    WallsInARow walls(Projection::perspective);
    walls.options.camera.clip = clip;
    EXPECT_EQ(tests::refused_parts<BadOption>([&] { walls.picture(); }).option, "clip");
  }
}

}  // namespace
}  // namespace gatelight::renderer

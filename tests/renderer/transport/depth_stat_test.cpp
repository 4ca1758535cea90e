// The length of paths: without limits only Russian roulette ends them, and it loses no light.

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "renderer/render.h"
#include "tests/support/picture_moments.h"
#include "tests/support/scene_builder.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;

const double kDepthSignificance = testing::sidak(1e-4, 8);

RenderOptions view(const Vec3& eye, int spp) {
  RenderOptions options;
  options.width = options.height = 24;
  options.spp = spp;
  options.filter = PixelFilter::box;
  options.camera.look_at = LookAt{eye, eye - Vec3(0.1f, 0.2f, 1.0f), Vec3(0, 1, 0)};
  return options;
}

TEST(WhiteRooms, HaveARadianceOfOne) {
  for (const float albedo : {0.5f, 0.8f, 0.9f, 0.99f}) {
    SceneBuilder builder;
    const int wall =
        builder.material(SceneBuilder::lambert(Color::Constant(albedo), Color::Constant(1.0f - albedo)));
    builder.box(wall, Vec3(-1, -1, -1), Vec3(1, 1, 1), true);
    const RenderOptions options = view(Vec3(0.1f, 0.2f, 0.5f), 256);
    const testing::Moments m = testing::channel_moments(Renderer(builder.scene(), options).render(), 0);
    EXPECT_GT(testing::mean_p_value(m, 1.0, 1e-5), kDepthSignificance)
        << albedo << ": mean " << m.mean() << " +- " << m.standard_error();
  }
}

/// The least and the largest pixel of a white sky behind blocks of clear glass.
std::pair<float, float> behind_blocks(int blocks, const std::optional<int>& max_depth,
                                      const std::optional<int>& max_transmission_depth) {
  SceneBuilder builder;
  scene::Material glass = SceneBuilder::clear_glass();
  glass.ior = 1.0f;
  glass.specular = 0.0f;  // else Schlick's curve reflects at grazing angles whatever the index
  glass.thickness = 1.0f;
  const int m = builder.material(glass);
  for (int i = 0; i < blocks; ++i) {
    const float front = -static_cast<float>(i);
    builder.box(m, Vec3(-9, -9, front - 0.5f), Vec3(9, 9, front));
  }
  RenderOptions options = view(Vec3(0, 0, 1), 4);
  options.environment.constant = Color::Ones();
  options.max_depth = max_depth;
  options.max_transmission_depth = max_transmission_depth;
  const Picture picture = Renderer(builder.scene(), options).render();
  const auto [least, largest] =
      std::minmax_element(picture.layers[0].values.begin(), picture.layers[0].values.end());
  return {*least, *largest};
}

TEST(Depth, GlassBehindGlassIsClear) {
  for (const int blocks : {1, 4, 20, 30}) {
    const auto [least, largest] = behind_blocks(blocks, std::nullopt, std::nullopt);
    EXPECT_NEAR(least, 1.0f, 1e-5f) << blocks;
    EXPECT_NEAR(largest, 1.0f, 1e-5f) << blocks;
  }
}

TEST(Depth, LimitsCountScatteringEventsAndTransmissions) {
  EXPECT_EQ(behind_blocks(4, 8, std::nullopt).first, 1.0f) << "two surfaces a block";
  EXPECT_EQ(behind_blocks(4, 7, std::nullopt).second, 0.0f);
  EXPECT_EQ(behind_blocks(4, std::nullopt, 8).first, 1.0f);
  EXPECT_EQ(behind_blocks(4, std::nullopt, 7).second, 0.0f);

  // Reflections are no transmissions.
  SceneBuilder builder;
  builder.box(builder.material(SceneBuilder::lambert(Color::Constant(0.5f), Color::Constant(0.5f))),
              Vec3(-1, -1, -1), Vec3(1, 1, 1), true);
  RenderOptions options = view(Vec3(0.1f, 0.2f, 0.5f), 16);
  const Picture free = Renderer(builder.scene(), options).render();
  options.max_transmission_depth = 0;
  EXPECT_EQ(Renderer(builder.scene(), options).render().layers[0].values, free.layers[0].values);
}

}  // namespace
}  // namespace gatelight::renderer

// Scenes of any size: everything scaled about the origin.

#include <gtest/gtest.h>

#include "tests/extremes/pictures.h"
#include "tests/support/room.h"

namespace gatelight::renderer {
namespace {

using namespace testing;

Rendered at_scale(RenderOptions options, float scale) {
  scene::Scene s = room();
  resize(s, scale);
  resize(options, scale);
  return render(s, options);
}

TEST(Scale, PowersOfTwoGiveTheSameBitsAndTraining) {
  for (const Integrator integrator : kAll) {
    const RenderOptions options = room_picture(integrator, 24);
    const Rendered one = at_scale(options, 1.0f);
    ASSERT_TRUE(one.sane());
    for (const int exponent : {-20, -10, 10, 20}) {
      const Rendered other = at_scale(options, std::ldexp(1.0f, exponent));
      EXPECT_TRUE(one.values == other.values) << enum_name(integrator) << " 2^" << exponent;
      EXPECT_EQ(one.statistics.cache.loss, other.statistics.cache.loss);
      EXPECT_EQ(one.statistics.cache.resolution_histogram, other.statistics.cache.resolution_histogram);
    }
  }
}

TEST(Scale, AnyScaleGivesTheSamePictureAndTraining) {
  for (const Integrator integrator : kAll) {
    const RenderOptions options = room_picture(integrator, 24);
    const Rendered one = at_scale(options, 1.0f);
    RenderOptions again = options;
    again.seed = 1;
    const double noise = block_error(one, at_scale(again, 1.0f), options.width);
    for (const float scale : {1e-6f, 1e-3f, 1e3f, 1e6f, 1e8f}) {
      const Rendered other = at_scale(options, scale);
      EXPECT_TRUE(other.sane());
      EXPECT_LT(block_error(one, other, options.width), 0.01 * noise) << enum_name(integrator) << scale;
      if (!uses_cache(integrator)) continue;
      EXPECT_EQ(one.statistics.cache.resolution_histogram, other.statistics.cache.resolution_histogram);
      EXPECT_NEAR(other.statistics.cache.loss / one.statistics.cache.loss, 1.0, 0.01);
    }
    const Rendered tiny = at_scale(options, std::ldexp(1.0f, -30));
    EXPECT_TRUE(tiny.sane());
    EXPECT_LT(block_error(one, tiny, options.width), 4.0 * noise);
  }
}

}  // namespace
}  // namespace gatelight::renderer

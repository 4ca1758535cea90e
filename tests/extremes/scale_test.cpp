// Scenes of any size: everything scaled about the origin.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/extremes/extreme.h"
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
  for (const Kind& kind : kKinds) {
    const RenderOptions options = room_picture(kind.integrator, 24);
    const Rendered one = at_scale(options, 1.0f);
    ASSERT_TRUE(one.sane());
    for (const int exponent : {-20, -10, 10, 20}) {
      const Rendered other = at_scale(options, std::ldexp(1.0f, exponent));
      EXPECT_EQ(different(one, other), 0u) << kind.name << " 2^" << exponent;
      EXPECT_EQ(one.statistics.cache.loss, other.statistics.cache.loss);
      EXPECT_EQ(one.statistics.cache.resolution_histogram, other.statistics.cache.resolution_histogram);
    }
  }
  report_extreme("a room scaled by powers of two", "2^-20 to 2^20; path, ao, nrc, nao",
                 "the same bits of every pixel, the same resolutions and loss", "");
}

TEST(Scale, AnyScaleGivesTheSamePictureAndTraining) {
  double worst = 0.0;
  double worst_loss = 0.0;
  for (const Kind& kind : kKinds) {
    const RenderOptions options = room_picture(kind.integrator, 24);
    const Rendered one = at_scale(options, 1.0f);
    RenderOptions again = options;
    again.seed = 1;
    const double noise = block_error(one, at_scale(again, 1.0f), options.width);
    for (const float scale : {1e-6f, 1e-3f, 1e3f, 1e6f, 1e8f}) {
      const Rendered other = at_scale(options, scale);
      EXPECT_TRUE(other.sane());
      worst = std::max(worst, block_error(one, other, options.width) / noise);
      if (!uses_cache(kind.integrator)) continue;
      EXPECT_EQ(one.statistics.cache.resolution_histogram, other.statistics.cache.resolution_histogram);
      worst_loss =
          std::max(worst_loss, std::abs(other.statistics.cache.loss / one.statistics.cache.loss - 1.0));
    }
    const Rendered tiny = at_scale(options, std::ldexp(1.0f, -30));
    EXPECT_TRUE(tiny.sane());
    EXPECT_LT(block_error(one, tiny, options.width), 4.0 * noise);
  }
  EXPECT_LT(worst, 0.01);
  EXPECT_LT(worst_loss, 0.01);
  report_extreme(
      "a room scaled", "1e-6 to 1e8; path, ao, nrc, nao",
      fmt::format("{:.1e} of the noise between two seeds (bound 0.01); the same resolutions, loss to {:.1e} "
                  "(bound 0.01); at 1e-9 another picture of the same noise",
                  worst, worst_loss),
      "");
}

}  // namespace
}  // namespace gatelight::renderer

// FLIP of a pair of pictures with published values. They are not part of the sources: GATELIGHT_FLIP_PAIR
// names a folder with tree-ref.png and tree-test.png of github.com/gfx-rs/nv-flip-rs (etc/).

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "renderer/image/image_read.h"
#include "renderer/metrics/flip.h"

namespace gatelight::renderer {
namespace {

TEST(FlipPair, HasThePublishedMeanAndQuartiles) {
  const char* folder = std::getenv("GATELIGHT_FLIP_PAIR");
  if (!folder) GTEST_SKIP() << "GATELIGHT_FLIP_PAIR is not set";
  const Picture reference = read_image(std::filesystem::path(folder) / "tree-ref.png");
  const Picture test = read_image(std::filesystem::path(folder) / "tree-test.png");
  const FlipSummary s = ldr_flip({reference, "tree-ref.png"}, {test, "tree-test.png"}).summary;
  // nv-flip/src/lib.rs there.
  EXPECT_NEAR(s.mean, 0.133285, 1e-4);
  EXPECT_NEAR(s.first_quartile, 0.184924, 1e-4);
  EXPECT_NEAR(s.weighted_median, 0.333241, 1e-4);
  EXPECT_NEAR(s.third_quartile, 0.503441, 1e-4);
  EXPECT_NEAR(s.max, 0.983044, 1e-4);
  EXPECT_EQ(s.min, 0.0);
}

}  // namespace
}  // namespace gatelight::renderer

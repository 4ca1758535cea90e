#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "renderer/image/srgb.h"
#include "tests/support/folder_test.h"
#include "tests/support/picture_files.h"
#include "tests/support/process.h"

namespace gatelight::tests {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class CompareFramesCommand : public FolderTest {
 protected:
  void even(const std::string& name, float value, int width = 4) const {
    write_even(path(name), width, 2, value);
  }

  /// Radiance 1 in the reference, and 1, 1.5, 1 and 2 in the test.
  void make_sequences() const {
    const std::array<float, 4> test{1.0f, 1.5f, 1.0f, 2.0f};
    for (std::size_t i = 0; i < test.size(); ++i) {
      even("r-000" + std::to_string(i) + ".exr", 1.0f);
      even("t0" + std::to_string(i) + ".exr", test[i]);
    }
  }

  Output compare(const Words& flags) const {
    return run_gatelight_inside(words_of("compare {} {}", {reference(), test()}, flags));
  }

  std::string reference() const { return path("r-%04d.exr"); }
  std::string test() const { return path("t##.exr"); }
};

TEST_F(CompareFramesCommand, JsonHasMeansAndAListOfFrames) {
  make_sequences();
  const Output output = expect_done(compare({"--frames", "0:3", "--exposure", "-2", "--json", "-"}));
  const json result = json::parse(output.out);
  EXPECT_EQ(result["reference"], reference());
  EXPECT_EQ(result["width"], 4);
  EXPECT_EQ(result["pixels"], 32);
  EXPECT_DOUBLE_EQ(result["mse"], 1.25 / 4.0);
  EXPECT_TRUE(result["psnr"].is_null()) << "equal frames have an infinite one";
  EXPECT_TRUE(result["ssim"].is_null());
  ASSERT_EQ(result["frames"].size(), 4);
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    const json& frame = result["frames"][static_cast<std::size_t>(i)];
    EXPECT_EQ(frame["frame"], i);
    sum += frame["flip"].get<double>();
  }
  EXPECT_DOUBLE_EQ(result["flip"]["mean"], sum / 4.0);
  EXPECT_EQ(result["flip"]["exposure"], -2.0);
  EXPECT_NEAR(result["frames"][1]["rel_mse"], 0.25 / 1.01, 1e-12);
  EXPECT_EQ(result["frames"][2]["flip"], 0.0);

  // Screen values of 0.25, 0.375, 0.25 and 0.5.
  const auto step = [](float value) {
    return renderer::linear_to_srgb(value) - renderer::linear_to_srgb(0.25f);
  };
  const double small = step(0.375f), large = step(0.5f);
  EXPECT_NEAR(result["temporal_low"], std::sqrt((2.0 * small * small + large * large) / 3.0), 1e-6);
  EXPECT_NEAR(result["temporal_high"], 0.0, 1e-6);
}

TEST_F(CompareFramesCommand, FramesFollowTheStep) {
  make_sequences();
  const json result = json::parse(compare({"--frames", "3:0:-2", "--metric", "mse", "--json", "-"}).out);
  ASSERT_EQ(result["frames"].size(), 2);
  EXPECT_EQ(result["frames"][0], json({{"frame", 3}, {"mse", 1.0}}));
  EXPECT_EQ(result["frames"][1], json({{"frame", 1}, {"mse", 0.25}}));
  EXPECT_EQ(result["mse"], 0.625);
  EXPECT_FALSE(result.contains("temporal_low"));
  // Only pairs of frames have a temporal deviation.
  const Output one = expect_done(compare({"--frames", "2:2"}));
  EXPECT_THAT(one.out, Not(HasSubstr("temporal")));
}

TEST_F(CompareFramesCommand, FlagsThatExcludeEachOtherAreRefused) {
  make_sequences();
  expect_failure(compare({"--frames", "0:3", "--halves", reference(), test()}), 1, {"--halves", "frames"});
  expect_failure(compare({"--frames", "0:3", "--error-map", path("e.png")}), 1, {"--error-map", "frames"});
  expect_failure(compare({"--frames", "2:2", "--metric", "temporal"}), 1, {"--metric", "temporal", "frames"});
  expect_failure(run_gatelight_inside({"compare", path("t00.exr"), path("t01.exr"), "--metric", "temporal"}),
                 1, {"--metric", "temporal", "--frames"});
  expect_failure(compare({}), 1, {"REFERENCE", reference(), "%04d"});
  expect_failure(run_gatelight_inside({"compare", path("t00.exr"), test()}), 1, {"TEST", test(), "##"});
  const std::string still = path("t00.exr");
  expect_failure(run_gatelight_inside({"compare", still, test(), "--frames", "0:3"}), 1,
                 {"REFERENCE", still});
  expect_failure(run_gatelight_inside({"compare", reference(), still, "--frames", "0:3"}), 1,
                 {"TEST", still});
  expect_failure(compare({"--frames", "0:3", "--json", path("t02.exr")}), 1, {"--json", "t02.exr", "TEST"});
}

TEST_F(CompareFramesCommand, FramesThatCannotBeComparedAreNamed) {
  make_sequences();
  const Output missing = compare({"--frames", "2:5", "--metric", "mse"});
  expect_failure(missing, 2, {"r-0004.exr"});
  EXPECT_EQ(missing.out, "");
  even("r-0004.exr", 1.0f, 5);
  even("t04.exr", 1.0f, 5);
  expect_failure(compare({"--frames", "2:4", "--metric", "mse"}), 2,
                 {"r-0002.exr", "4x2", "r-0004.exr", "5x2"});
  even("t03.exr", std::numeric_limits<float>::infinity());
  expect_failure(compare({"--frames", "2:3", "--metric", "temporal"}), 2, {"8", "t03.exr", "temporal"});
}

}  // namespace
}  // namespace gatelight::tests

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "tests/support/folder_test.h"
#include "tests/support/picture_files.h"
#include "tests/support/process.h"

namespace gatelight::tests {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class CompareCommand : public FolderTest {
 protected:
  std::string picture(const std::string& name, int width, int height, float value,
                      std::map<std::string, std::string> metadata = {}) const {
    return write_even(path(name), width, height, value, std::move(metadata));
  }
  static Output compare(const std::string& reference, const std::string& test, const Words& more = {}) {
    return run_gatelight_inside(words_of("compare {} {}", {reference, test}, more));
  }
  static json results(const std::string& reference, const std::string& test, const Words& more = {}) {
    return json::parse(expect_done(compare(reference, test, words_of("--json -", {}, more))).out);
  }
};

TEST_F(CompareCommand, PrintsTextAndJson) {
  const std::string reference = picture("r.exr", 4, 2, 1.0f);
  const std::string test = picture("t.exr", 4, 2, 1.5f);
  const Output text = expect_done(compare(reference, test));
  EXPECT_THAT(text.out, AllOf(HasSubstr("mse              0.25\n"), HasSubstr("max_error        0.5\n")));
  const json result = results(reference, test);
  EXPECT_DOUBLE_EQ(result["mse"], 0.25);
  EXPECT_NEAR(result["rel_mse"], 0.25 / 1.01, 1e-12);
  EXPECT_DOUBLE_EQ(result["psnr"], -10.0 * std::log10(0.25));
  EXPECT_DOUBLE_EQ(result["max_error"], 0.5);
  EXPECT_DOUBLE_EQ(result["mean_error"], 0.5);
  EXPECT_DOUBLE_EQ(result["mean_difference"], 0.5);
  EXPECT_EQ(result["pixels"], 8);
}

TEST_F(CompareCommand, MetricsAreChosenByName) {
  const std::string reference = picture("r.exr", 1, 1, 1.0f);
  const Output output =
      expect_done(compare(reference, reference, {"--metric", "psnr,max", "--json", path("o.json")}));
  EXPECT_THAT(output.out, AllOf(HasSubstr("psnr             inf dB"), Not(HasSubstr("mse"))));
  const json result = json::parse(read_file(path("o.json")));
  EXPECT_TRUE(result["psnr"].is_null()) << "JSON has no infinity";
  EXPECT_FALSE(result.contains("mse"));
  expect_failure(compare(reference, reference, {"--metric", "lpips"}), 1,
                 {"lpips", "metric", "mse|rel_mse|psnr|mean|max|ssim|flip|hdr_flip"});
}

TEST_F(CompareCommand, FlipIsPrintedAndWrittenWithItsQuartiles) {
  // Uniform pictures: the same error everywhere.
  const std::string reference = picture("r.exr", 4, 2, 0.5f);
  const std::string test = picture("t.exr", 4, 2, 1.0f);
  const Output text = compare(reference, test);
  EXPECT_THAT(text.out, AllOf(HasSubstr("flip             0."), HasSubstr("hdr_flip         0."),
                              HasSubstr("weighted quartiles 0.")));
  const json result = results(reference, test);
  for (const char* metric : {"flip", "hdr_flip"}) {
    const double mean = result[metric]["mean"];
    EXPECT_GT(mean, 0.1);
    for (const char* key : {"weighted_median", "first_quartile", "third_quartile", "min", "max"}) {
      EXPECT_NEAR(result[metric][key], mean, 1e-5) << metric << " " << key;
    }
    EXPECT_NEAR(result[metric]["pixels_per_degree"], 67.0206, 1e-4);
  }
  EXPECT_EQ(result["flip"]["tonemap"], "none");
  EXPECT_EQ(result["hdr_flip"]["exposures"], 2);
}

TEST_F(CompareCommand, SsimIsPrintedAndWrittenWhereItsWindowFits) {
  const std::string black = picture("b.exr", 12, 11, 0.0f);
  const std::string white = picture("w.exr", 12, 11, 4.0f);
  EXPECT_THAT(compare(black, white).out, HasSubstr("ssim             9.999e-05\n"));
  const auto ssim = [&](const Words& flags) {
    return results(black, white, words_of("--metric ssim", {}, flags))["ssim"];
  };
  EXPECT_NEAR(ssim({})["mean"], 1e-4 / 1.0001, 1e-9);
  // 2^-3 of the radiance is 0.5, which sRGB shows as 0.7354.
  EXPECT_NEAR(ssim({"--exposure", "-3"})["mean"], 1e-4 / (0.7353569 * 0.7353569 + 1e-4), 1e-9);
  EXPECT_EQ(ssim({"--exposure", "-3"})["exposure"], -3.0);
  EXPECT_EQ(ssim({"--tonemap", "filmic"})["tonemap"], "filmic");

  const std::string small = picture("s.exr", 12, 10, 1.0f);
  const Output output = expect_done(compare(small, small, {"--json", "-"}));
  EXPECT_EQ(output.err, "");
  EXPECT_TRUE(json::parse(output.out)["ssim"].is_null());
  EXPECT_THAT(compare(small, small).out, HasSubstr("ssim             -\n"));
  expect_failure(compare(small, small, {"--metric", "ssim"}), 2, {"s.exr", "11x11"});
}

TEST_F(CompareCommand, FlipFollowsExposureCurveAndPixelsPerDegree) {
  const std::string reference = picture("r.exr", 4, 2, 4.0f);
  const std::string test = picture("t.exr", 4, 2, 8.0f);
  const auto flip = [&](const Words& flags) {
    return results(reference, test, words_of("--metric flip", {}, flags))["flip"];
  };
  EXPECT_EQ(flip({})["mean"], 0.0) << "both are white";
  EXPECT_GT(flip({"--exposure", "-3"})["mean"], 0.1);
  EXPECT_GT(flip({"--exposure", "-3", "--tonemap", "filmic"})["mean"], 0.05);
  EXPECT_EQ(flip({"--exposure", "-3"})["exposure"], -3.0);
  EXPECT_EQ(flip({"--pixels-per-degree", "20"})["pixels_per_degree"], 20.0);
  EXPECT_EQ(compare(reference, test, {"--pixels-per-degree", "0"}).exit_code, 1);
}

TEST_F(CompareCommand, HalvesAlsoEstimateTheBias) {
  // Means: 1 and 2. Products of the halves' differences: (2 - 0.5) (2 - 1.5).
  const std::string r1 = picture("r1.exr", 2, 2, 0.5f);
  const std::string r2 = picture("r2.exr", 2, 2, 1.5f);
  const std::string test = picture("t.exr", 2, 2, 2.0f);
  const Output output = expect_done(compare(r1, test, {"--halves", r2, test, "--json", "-"}));
  const json result = json::parse(output.out);
  EXPECT_NEAR(result["bias_rel_mse"], 1.5 * 0.5 / 1.01, 1e-12);
  EXPECT_NEAR(result["rel_mse"], 1.0 / 1.01, 1e-12);
  EXPECT_EQ(result["halves"], json::array({r2, test}));
  EXPECT_THAT(compare(r1, test, {"--halves", r2, test, "--metric", "max"}).out,
              AllOf(HasSubstr("max_error        1\n"), HasSubstr("bias_rel_mse     0.742574\n")));
  EXPECT_FALSE(results(r1, test).contains("bias_rel_mse"));
  EXPECT_EQ(compare(r1, test, {"--halves", r2}).exit_code, 1);
  const Output sizes = compare(r1, test, {"--halves", r2, picture("n.exr", 1, 2, 2.0f)});
  expect_failure(sizes, 2, {"n.exr"});
}

TEST_F(CompareCommand, HalvesWithEqualSeedsGiveAWarning) {
  const auto half = [&](const std::string& name, const std::string& seed) {
    return picture(name, 1, 1, 1.0f, {{"spp", "1"}, {"seed", seed}});
  };
  const std::string r1 = half("r1.exr", "7"), r2 = half("r2.exr", "8");
  const std::string t1 = half("t1.exr", "7"), t2 = half("t2.exr", "8");
  // A reference and a test may have the same seed.
  const Output good = expect_done(compare(r1, t1, {"--halves", r2, t2}));
  EXPECT_EQ(good.err, "");
  const Output references = expect_done(compare(r1, r2, {"--halves", t1, t2}));
  expect_messages(references.error_lines(), {{"r1.exr", "t1.exr", "7"}, {"r2.exr", "t2.exr", "8"}});
}

TEST_F(CompareCommand, ErrorMapIsAPictureOfTheSameSize) {
  const std::string reference = picture("r.exr", 5, 3, 1.0f);
  const std::string test = picture("t.exr", 5, 3, 9.0f);
  expect_done(compare(reference, test, {"--error-map", path("e.png"), "--map", "relative"}));
  const renderer::Picture relative = renderer::read_image(path("e.png"));
  EXPECT_EQ(relative.width, 5);
  EXPECT_EQ(relative.height, 3);
  EXPECT_EQ(relative.layers[0].values, std::vector<float>(45, 1.0f));
  // Both are shown white, but not at the exposures of HDR-FLIP. The first colour of the map has no red.
  const auto red = [&](const Words& flags) {
    expect_done(compare(reference, test, words_of("--metric mse --error-map {}", {path("f.png")}, flags)));
    const renderer::Picture map = renderer::read_image(path("f.png"));
    EXPECT_EQ(map.width * map.height, 15);
    return map.layers[0].values.front();
  };
  EXPECT_EQ(red({}), 0.0f);
  EXPECT_GT(red({"--map", "hdr_flip"}), 0.01f);
  EXPECT_EQ(compare(reference, test, {"--error-map", path("e.exr")}).exit_code, 1);
  EXPECT_EQ(compare(reference, test, {"--error-map", path("no/e.png")}).exit_code, 3);
}

TEST_F(CompareCommand, UnusablePicturesAreCode2) {
  const std::string reference = picture("r.exr", 2, 2, 1.0f);
  expect_failure(compare(reference, picture("t.exr", 2, 3, 1.0f)), 2, {"r.exr", "t.exr", "2x3"});
  renderer::Picture grey{.width = 2, .height = 2};
  grey.layers = {{.channels = {"Y"}, .values = std::vector<float>(4, 1.0f)}};
  renderer::write_image(grey, folder / "grey.exr", {.exr_float = true});
  expect_failure(compare(reference, path("grey.exr")), 2, {"grey.exr", "r.exr"});
  expect_failure(compare(reference, path("missing.exr")), 2, {"missing.exr"});
  folder.write("broken.png", "no picture");
  EXPECT_EQ(compare(reference, path("broken.png")).exit_code, 2);
  const std::string never_finite = picture("nan.exr", 2, 2, std::nanf(""));
  expect_failure(compare(reference, never_finite, {"--metric", "mse"}), 2, {"4", never_finite});
}

TEST_F(CompareCommand, NonFinitePixelsAreRefusedWithTheirCounts) {
  const std::string reference = picture("r.exr", 12, 11, 1.0f);
  const std::string test = picture("t.exr", 12, 11, std::nanf(""));
  for (const char* flags :
       {"", "--metric hdr_flip", "--metric ssim", "--metric mse,flip", "--metric mse --error-map {}"}) {
    for (const auto& [first, second] : {std::pair(reference, test), std::pair(test, reference)}) {
      const Words more = words_of(flags, std::string(flags).ends_with("{}") ? Words{path("e.png")} : Words());
      const Output output = compare(first, second, words_of("--json {}", {path("o.json")}, more));
      expect_failure(output, 2, {"132", test, "0", reference, "--metric mse,rel_mse,psnr,mean,max"});
      EXPECT_EQ(output.out, "");
    }
  }
  EXPECT_FALSE(std::filesystem::exists(path("o.json")));
  EXPECT_FALSE(std::filesystem::exists(path("e.png")));
}

TEST_F(CompareCommand, MeansByNameLeaveNonFinitePixelsOutAndCountThem) {
  const std::string reference = picture("r.exr", 2, 1, 1.0f);
  renderer::Picture half{.width = 2, .height = 1};
  half.layers = {{.channels = {"R", "G", "B"}, .values = {1, 1, 1, 1, std::nanf(""), 1}}};
  renderer::write_image(half, folder / "t.exr", {.exr_float = true});
  const std::string test = path("t.exr");
  const Output output = expect_done(compare(reference, test,
                                            {"--metric", "mse,rel_mse,psnr,mean,max", "--json", "-",
                                             "--error-map", path("e.png"), "--map", "relative"}));
  expect_messages(output.error_lines(), {{"1", test}});
  EXPECT_EQ(json::parse(output.out)["nonfinite"]["test"], 1);
  EXPECT_EQ(json::parse(output.out)["pixels"], 1);
  EXPECT_TRUE(std::filesystem::exists(path("e.png")));
}

TEST_F(CompareCommand, ResultsDoNotReplaceTheComparedFiles) {
  const std::string reference = picture("r.exr", 2, 1, 1.0f);
  const std::string test = picture("t.exr", 2, 1, 1.0f);
  for (const std::string& file : {reference, test}) {
    const std::string before = read_file(file);
    const Output output = compare(reference, test, {"--json", file});
    expect_failure(output, 1, {"--json", file});
    EXPECT_EQ(read_file(file), before);
  }
  const std::string map = path("e.png");
  EXPECT_EQ(compare(reference, test, {"--error-map", map, "--json", map}).exit_code, 1);
}

}  // namespace
}  // namespace gatelight::tests

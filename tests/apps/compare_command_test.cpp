#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/image_read.h"
#include "renderer/image_write.h"
#include "tests/apps/process.h"
#include "tests/temporary_folder.h"

namespace gatelight::tests {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class CompareCommand : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder / name).string(); }

  std::string picture(const std::string& name, int width, int height, float value) const {
    renderer::Picture picture{.width = width, .height = height};
    picture.layers = {{.channels = {"R", "G", "B"},
                       .values = std::vector<float>(static_cast<std::size_t>(3 * width * height), value)}};
    renderer::write_image(picture, folder / name, {.exr_float = true});
    return path(name);
  }

  TemporaryFolder folder;
};

TEST_F(CompareCommand, PrintsTextAndJson) {
  const std::string reference = picture("r.exr", 4, 2, 1.0f);
  const std::string test = picture("t.exr", 4, 2, 1.5f);
  const Output text = run_gatelight({"compare", reference, test});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, AllOf(HasSubstr("mse              0.25\n"), HasSubstr("max_error        0.5\n")));
  const Output as_json = run_gatelight({"compare", reference, test, "--json", "-"});
  const json result = json::parse(as_json.out);
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
      run_gatelight({"compare", reference, reference, "--metric", "psnr,max", "--json", path("o.json")});
  EXPECT_EQ(output.exit_code, 0) << output.err;
  EXPECT_THAT(output.out, AllOf(HasSubstr("psnr             inf dB"), Not(HasSubstr("mse"))));
  const json result = json::parse(read_file(path("o.json")));
  EXPECT_TRUE(result["psnr"].is_null()) << "JSON has no infinity";
  EXPECT_FALSE(result.contains("mse"));
  const Output unknown = run_gatelight({"compare", reference, reference, "--metric", "ssim"});
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.last_error_line(), AllOf(HasSubstr("'ssim'"), HasSubstr("mse|rel_mse|psnr|mean|max")));
}

TEST_F(CompareCommand, ErrorMapIsAPictureOfTheSameSize) {
  const std::string reference = picture("r.exr", 5, 3, 1.0f);
  const std::string test = picture("t.exr", 5, 3, 9.0f);
  ASSERT_EQ(run_gatelight({"compare", reference, test, "--error-map", path("e.png")}).exit_code, 0);
  const renderer::Picture map = renderer::read_image(path("e.png"));
  EXPECT_EQ(map.width, 5);
  EXPECT_EQ(map.height, 3);
  EXPECT_EQ(map.layers[0].values, std::vector<float>(45, 1.0f));
  EXPECT_EQ(run_gatelight({"compare", reference, test, "--error-map", path("e.exr")}).exit_code, 1);
  EXPECT_EQ(run_gatelight({"compare", reference, test, "--error-map", path("no/e.png")}).exit_code, 3);
}

TEST_F(CompareCommand, UnusablePicturesAreCode2) {
  const std::string reference = picture("r.exr", 2, 2, 1.0f);
  const Output sizes = run_gatelight({"compare", reference, picture("t.exr", 2, 3, 1.0f)});
  EXPECT_EQ(sizes.exit_code, 2);
  EXPECT_EQ(sizes.out, "");
  EXPECT_THAT(sizes.last_error_line(), AllOf(HasSubstr("r.exr"), HasSubstr("t.exr"), HasSubstr("2x3")));
  const Output missing = run_gatelight({"compare", reference, path("missing.exr")});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.last_error_line(), HasSubstr("missing.exr"));
  folder.write("broken.png", "no picture");
  EXPECT_EQ(run_gatelight({"compare", reference, path("broken.png")}).exit_code, 2);
}

TEST_F(CompareCommand, NonFinitePixelsAreReported) {
  const std::string reference = picture("r.exr", 2, 1, 1.0f);
  const Output output =
      run_gatelight({"compare", reference, picture("t.exr", 2, 1, std::nanf("")), "--json", "-"});
  EXPECT_EQ(output.exit_code, 0);
  EXPECT_THAT(output.err, HasSubstr("2 in '" + path("t.exr") + "'"));
  EXPECT_EQ(json::parse(output.out)["nonfinite"]["test"], 2);
}

}  // namespace
}  // namespace gatelight::tests

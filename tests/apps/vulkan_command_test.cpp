// --device vulkan through the real program: the CPU's picture, files for both, and refusals.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/folder_test.h"
#include "tests/support/process.h"

namespace gatelight::tests {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const json& devices() {
  static const json description = json::parse(run_gatelight({"info", "--json", "-"}).out)["vulkan"];
  return description;
}

bool has_usable_device() {
  for (const json& device : devices()["devices"])
    if (device["usable"]) return true;
  return false;
}

class VulkanCommand : public FolderTest {
 protected:
  void SetUp() override {
    if (has_usable_device()) return;
    if (std::getenv("GATELIGHT_REQUIRE_VULKAN") != nullptr) FAIL() << "no Vulkan device: " << devices();
    GTEST_SKIP() << "no Vulkan device";
  }

  static Output render(const Words& flags) {
    return run_gatelight(
        words_of("render {} --quiet", {GATELIGHT_SOURCE_DIR "/data/cornell-box.glb"}, flags));
  }

  double flip(const std::string& a, const std::string& b) const {
    const Output output =
        expect_done(run_gatelight({"compare", path(a), path(b), "--metric", "flip", "--json", "-"}));
    return json::parse(output.out)["flip"]["mean"];
  }
};

TEST_F(VulkanCommand, BothDevicesRenderTheSamePicture) {
  for (const char* cache : {"--integrator nrc", "--integrator nao", "--integrator nrc --encoding hashgrid"}) {
    // Half precision would round the difference away.
    for (const char* device : {"cpu", "vulkan"})
      expect_done(
          render(words_of("--size 64x48 --spp 2 --device {} --train-steps 48 --batch 512 --exr float -o {}",
                          {device, path(std::string(device) + ".exr")}, words_of(cache))));
    const double difference = flip("cpu.exr", "vulkan.exr");
    EXPECT_GT(difference, 0.0);
    EXPECT_LT(difference, 0.005) << cache;
  }
}

TEST_F(VulkanCommand, StatisticsNameTheDevice) {
  const Output output =
      expect_done(render({"--integrator", "nrc", "--size", "24x16", "--spp", "1", "--train-steps", "4",
                          "--batch", "256", "--device", "vulkan:0", "-o", path("a.exr"), "--stats", "-"}));
  const json stats = json::parse(output.out);
  EXPECT_EQ(stats["device"], "vulkan:0");
  EXPECT_EQ(stats["cache"]["backend"], "vulkan " + std::string(devices()["devices"][0]["name"]));
}

// The device is lost after 4 submissions, in training, or after 40, while the cache answers.
TEST_F(VulkanCommand, ALostDeviceIsCode5AndKeepsThePictureSoFar) {
  const Words words =
      words_of("--integrator nrc --size 24x16 --spp 64 --train-steps 8 --batch 256 --device vulkan -o {}",
               {path("a.exr")});
  for (const auto& [after, picture] : {std::pair{"4", false}, {"40", true}}) {
    setenv("GATELIGHT_VULKAN_LOSE_AFTER", after, 1);
    const Output output = render(words);
    unsetenv("GATELIGHT_VULKAN_LOSE_AFTER");
    expect_failure(output, 5, {"--device cpu"});
    EXPECT_EQ(std::filesystem::exists(path("a.exr")), picture) << output.err;
  }
}

TEST_F(VulkanCommand, ACheckpointOutlivesALostDevice) {
  const auto words = [&](const std::string& picture) {
    return words_of(
        "--integrator nrc --size 24x16 --spp 32 --train-steps 24 --batch 256 --device vulkan -o {} "
        "--checkpoint {} --checkpoint-every 0 --resume",
        {path(picture), path("checkpoint")});
  };
  for (const char* after : {"6", "40"}) {
    setenv("GATELIGHT_VULKAN_LOSE_AFTER", after, 1);
    const Output lost = render(words("resumed.exr"));
    unsetenv("GATELIGHT_VULKAN_LOSE_AFTER");
    EXPECT_EQ(lost.exit_code, 5);
    ASSERT_TRUE(std::filesystem::exists(path("checkpoint"))) << "after " << after;
    expect_done(render(words("resumed.exr")));
    std::filesystem::remove(path("checkpoint"));
    expect_done(render(words("whole.exr")));
    std::filesystem::remove(path("checkpoint"));
    EXPECT_EQ(flip("whole.exr", "resumed.exr"), 0.0) << "after " << after;
  }
}

TEST(VulkanRefusals, AMissingDeviceIsCode5AndTheErrorNamesThoseThatExist) {
  const TemporaryFolder folder;
  const Output output = run_gatelight({"render", std::string(GATELIGHT_SOURCE_DIR) + "/data/cornell-box.glb",
                                       "--integrator", "nrc", "--size", "8x8", "--device", "vulkan:abacus",
                                       "-o", (folder / "a.exr").string(), "--quiet"});
  expect_failure(output, 5, {"--device: 'vulkan:abacus'", "--device cpu"});
  EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
}

TEST(VulkanInfo, ListsDevicesOrSaysWhyThereAreNone) {
  const json& description = devices();
  const Output output = expect_done(run_gatelight({"info"}));
  if (description["devices"].empty()) {
    EXPECT_THAT(output.out, HasSubstr(std::string(description["reason"])));
    return;
  }
  for (const json& device : description["devices"])
    EXPECT_THAT(output.out, HasSubstr(std::string(device["name"])));
}

}  // namespace
}  // namespace gatelight::tests

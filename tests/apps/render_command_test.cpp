// Pictures of real renders through the real program, and what info says of scenes.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "renderer/image/cryptomatte.h"
#include "renderer/image/image_read.h"
#include "tests/apps/render_command.h"
#include "tests/support/denoiser.h"
#include "tests/support/picture_files.h"

namespace gatelight::tests {
namespace {

using nlohmann::json;
using renderer::Picture;
using renderer::read_image;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::UnorderedElementsAre;

class RenderCommand : public SquareRenders {};

TEST_F(RenderCommand, ATimeIsInTheRecipeAndDecidesWhoseCheckpointItIs) {
  const auto render_at = [&](const std::string& time) {
    return run_gatelight(
        words_of("render {} --time {} --animation walk --size 8x8 --spp 16777216 --time-limit 0.1 -o {} "
                 "--stats {} --checkpoint {} --resume --quiet",
                 {GATELIGHT_SOURCE_DIR "/data/figure.glb", time, path("a.exr"), path("s.json"), path("c")}));
  };
  expect_done(render_at("0.25"));
  const json options = json::parse(read_file(path("s.json")))["options"];
  EXPECT_EQ(options["time"], 0.25);
  EXPECT_EQ(options["animation"], "walk");
  ASSERT_TRUE(std::filesystem::exists(path("c")));
  expect_done(render_at("0.25"));
  expect_failure(render_at("0.5"), 2, {path("c"), "geometry"});
}

TEST_F(RenderCommand, CryptomattesAreInTheExrAndStayWhenItIsMergedAndDenoised) {
  GATELIGHT_NEEDS_DENOISER();
  for (const char* seed : {"1", "2"}) {
    const Output output =
        expect_done(render({"-o", path(fmt::format("{}.exr", seed)), "--cryptomatte", "material,object",
                            "--seed", seed, "--aov", "denoising", "--stats", "-"}));
    EXPECT_THAT(output.err, HasSubstr(", cryptomatte 0."));
    const json stats = json::parse(output.out);
    EXPECT_EQ(stats["options"]["cryptomatte"], json({"object", "material"}));
    EXPECT_GT(stats["seconds"]["cryptomatte"], 0.0);
  }
  expect_done(run_gatelight({"merge", path("1.exr"), path("2.exr"), "-o", path("m.exr")}));
  expect_done(run_gatelight({"denoise", path("m.exr"), "-o", path("r.exr")}));
  const Picture first = read_image(path("1.exr"));
  for (const char* name : {"1.exr", "m.exr", "r.exr"}) {
    const Picture picture = read_image(path(name));
    std::set<std::string> manifests;
    for (const auto& [key, value] : picture.attributes) {
      if (key.ends_with("/manifest")) manifests.insert(value);
    }
    // The square's node has no name, nor has its material.
    EXPECT_THAT(manifests,
                UnorderedElementsAre(
                    fmt::format(R"({{"node 0":"{:08x}"}})", renderer::cryptomatte_id("node 0")),
                    fmt::format(R"({{"material 0":"{:08x}"}})", renderer::cryptomatte_id("material 0"))))
        << name;
    for (const char* kind : {"CryptoObject", "CryptoMaterial"}) {
      const renderer::Layer* layer = picture.find(fmt::format("{}00", kind));
      ASSERT_NE(layer, nullptr) << name;
      EXPECT_EQ(layer->values, first.find(layer->name)->values) << name;
      const float* middle = &layer->values[4 * (8 * 24 + 12)];
      EXPECT_EQ(std::bit_cast<std::uint32_t>(middle[0]),
                renderer::cryptomatte_id(kind == std::string("CryptoObject") ? "node 0" : "material 0"));
      EXPECT_EQ(middle[1], 1.0f);
      EXPECT_EQ(layer->values[0], 0.0f) << "the corner sees the sky";
    }
  }
  const Output info = run_gatelight({"info", path("1.exr")});
  EXPECT_THAT(info.out, ::testing::ContainsRegex("\n--cryptomatte +object,material\n"));
}

TEST_F(RenderCommand, CryptomattesThatNoOutputStoresGiveAWarning) {
  const Output output = expect_done(render({"-o", path("a.png"), "--cryptomatte", "object"}));
  expect_messages(output.warnings(), {{"--cryptomatte", ".exr"}});
}

TEST_F(RenderCommand, AnInstructionSetThatIsMissingIsCode5) {
  const std::string best = json::parse(run_gatelight({"info", "--json", "-"}).out)["isa"];
  if (best == "avx512") GTEST_SKIP() << "this machine has them all";
  const Output output = render({"-o", path("a.exr"), "--isa", "avx512"});
  expect_failure(output, 5, {"avx512", "--isa auto"});  // and those of this machine
}

TEST_F(RenderCommand, ASceneReadsNothingOutsideItsFolderUnlessThatIsAllowed) {
  json gltf = json::parse(tiny_scene());
  const float corners[18] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, -1, 0, 1, 1, 0, -1, 1, 0};
  folder.write("scene.bin", std::string(reinterpret_cast<const char*>(corners), sizeof(corners)));
  gltf["buffers"][0]["uri"] = "%2e%2e/scene.bin";
  const std::string inner = folder.write("inner/scene.gltf", gltf.dump());
  const Words render = words_of("render {} -o {} --spp 1 --size 8x8", {inner, path("a.png")});
  for (Words call : {render, {"info", inner}, {"sweep", inner, "-o", path("sweep")}}) {
    const Output output = run_gatelight_inside(call);
    expect_failure(output, 2, {"inner/scene.gltf", "buffers[0].uri", "%2e%2e/scene.bin", "--allow-external"});
    EXPECT_FALSE(std::filesystem::exists(path("a.png")));
    if (call[0] == "sweep") continue;
    call.push_back("--allow-external");
    EXPECT_EQ(run_gatelight_inside(call).exit_code, 0) << call[0];
    std::filesystem::remove(path("a.png"));
  }
}

TEST_F(RenderCommand, InfoListsTheContentsOfAScene) {
  const Output text = expect_done(run_gatelight({"info", scene}));
  EXPECT_THAT(text.out, HasSubstr("'front'"));
  std::string odd = tiny_scene();
  odd.replace(odd.rfind("\"front\", \"type\""), 7, R"("a\n\u001b]0;b")");
  const Output description = expect_done(run_gatelight_inside({"info", folder.write("odd.gltf", odd)}));
  EXPECT_THAT(description.out, HasSubstr("'a  ]0;b'")) << "no control characters reach the terminal";
  const json info = json::parse(run_gatelight({"info", scene, "--json", "-"}).out);
  EXPECT_EQ(info["triangles"], 2);
  EXPECT_EQ(info["cameras"][0]["name"], "front");
  EXPECT_EQ(info["requirements"]["transmission"], false);
  EXPECT_EQ(info["bounds"]["max"], json({1.0, 1.0, 0.0}));
  const json program = json::parse(run_gatelight({"info", "--json", "-"}).out);
  EXPECT_THAT(keys(program), IsSupersetOf({"version", "isa", "threads", "embree"}));
}

}  // namespace
}  // namespace gatelight::tests

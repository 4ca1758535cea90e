// Real renders through the real program.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "renderer/image/cryptomatte.h"
#include "renderer/image/image_read.h"
#include "tests/support/denoiser.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

using nlohmann::json;
using renderer::Picture;
using renderer::read_image;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

class RenderCommand : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder / name).string(); }

  Output render(const std::vector<std::string>& flags) const {
    if (std::find(flags.begin(), flags.end(), "--spp") != flags.end()) return render_open(flags);
    std::vector<std::string> more = flags;
    more.insert(more.end(), {"--spp", "4"});
    return render_open(more);
  }

  /// Renders without --spp.
  Output render_open(const std::vector<std::string>& flags) const {
    std::vector<std::string> arguments = {"render", scene, "--environment", "1,1,1", "--size", "24x16"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return run_gatelight(arguments);
  }

  TemporaryFolder folder;
  std::string scene = folder.write("scene.gltf", tiny_scene());
};

std::set<std::string> keys(const json& object) {
  std::set<std::string> names;
  for (const auto& [key, value] : object.items()) names.insert(key);
  return names;
}

TEST_F(RenderCommand, WritesEveryOutputAndNothingToStdout) {
  const Output output = render({"-o", path("a.exr"), "-o", path("b.png")});
  EXPECT_EQ(output.exit_code, 0) << output.err;
  EXPECT_EQ(output.out, "");
  for (const char* word :
       {"a.exr", "b.png", "load", "build", "render", "write", "1 536", "million/s", "rays", "memory"}) {
    EXPECT_THAT(output.err, HasSubstr(word));
  }
  for (const char* name : {"a.exr", "b.png"}) {
    const Picture picture = read_image(path(name));
    EXPECT_EQ(picture.width, 24);
    EXPECT_EQ(picture.height, 16);
  }
}

TEST_F(RenderCommand, TheSquareReflectsHalfOfAWhiteSky) {
  ASSERT_EQ(render({"-o", path("a.exr"), "--exr", "float", "--spp", "256", "--quiet"}).exit_code, 0);
  const Picture picture = read_image(path("a.exr"));
  const std::vector<float>& values = picture.layers[0].values;
  // The corner sees the sky, the middle a rough dielectric: half of the light, and what its surface reflects.
  EXPECT_NEAR(values[0], 1.0f, 1e-5f);
  const float middle = values[3 * (8 * 24 + 12)];
  EXPECT_GT(middle, 0.45f);
  EXPECT_LT(middle, 0.60f);
}

TEST_F(RenderCommand, QuietPrintsNothing) {
  const Output output = render({"-o", path("a.png"), "--quiet", "--progress", "json"});
  EXPECT_EQ(output.exit_code, 0);
  EXPECT_EQ(output.out, "");
  EXPECT_EQ(output.err, "");
}

TEST_F(RenderCommand, StatisticsHoldEveryKeyOfTheSchema) {
  const Output output = render({"-o", path("a.exr"), "--stats", path("s.json"), "--seed", "5"});
  ASSERT_EQ(output.exit_code, 0) << output.err;
  const json stats = json::parse(read_file(path("s.json")));
  EXPECT_THAT(keys(stats), IsSupersetOf({"schema", "version", "command", "options", "isa", "threads",
                                         "device", "width", "height", "spp", "samples", "seconds", "rays",
                                         "memory_bytes", "nonfinite", "clamped", "warnings"}));
  EXPECT_EQ(stats["schema"], 1);
  EXPECT_EQ(stats["device"], "cpu");
  EXPECT_EQ(stats["command"][1], "render");
  EXPECT_EQ(stats["width"], 24);
  EXPECT_EQ(stats["height"], 16);
  EXPECT_EQ(stats["spp"], 4);
  EXPECT_EQ(stats["samples"], 24 * 16 * 4);
  EXPECT_EQ(stats["interrupted"], false);
  EXPECT_GE(stats["threads"], 1);
  EXPECT_THAT(stats["isa"].get<std::string>(),
              ::testing::AnyOf("scalar", "sse2", "sse4.2", "avx", "avx2", "avx512"));
  EXPECT_THAT(keys(stats["seconds"]), IsSupersetOf({"load", "build", "render", "write", "total"}));
  double parts = 0.0;
  for (const char* part : {"load", "build", "render", "write"}) {
    EXPECT_GE(stats["seconds"][part], 0.0) << part;
    parts += stats["seconds"][part].get<double>();
  }
  EXPECT_GE(stats["seconds"]["total"].get<double>() + 1e-3, parts);
  EXPECT_THAT(keys(stats["rays"]), UnorderedElementsAre("camera", "bounce", "shadow"));
  EXPECT_EQ(stats["rays"]["camera"], 24 * 16 * 4);
  EXPECT_GT(stats["rays"]["shadow"], 0);
  EXPECT_THAT(keys(stats["memory_bytes"]), IsSupersetOf({"geometry", "bvh", "textures", "peak_rss"}));
  EXPECT_GT(stats["memory_bytes"]["peak_rss"], 1 << 20);
  EXPECT_GT(stats["memory_bytes"]["bvh"], 0);
  EXPECT_EQ(stats["nonfinite"]["count"], 0);
  EXPECT_TRUE(stats["nonfinite"]["samples"].is_array());
  EXPECT_EQ(stats["clamped"], 0);
  EXPECT_TRUE(stats["warnings"].is_array());
  EXPECT_THAT(keys(stats["options"]), IsSupersetOf({"integrator",
                                                    "size",
                                                    "spp",
                                                    "time-limit",
                                                    "max-depth",
                                                    "min-depth",
                                                    "seed",
                                                    "sampler",
                                                    "filter",
                                                    "direct",
                                                    "mis",
                                                    "light-selection",
                                                    "clamp",
                                                    "aov",
                                                    "nan",
                                                    "isa",
                                                    "environment",
                                                    "environment-rotation",
                                                    "environment-scale",
                                                    "missing",
                                                    "allow-external",
                                                    "exposure",
                                                    "tonemap",
                                                    "exr",
                                                    "threads",
                                                    "memory-limit",
                                                    "output"}));
  EXPECT_EQ(stats["options"]["seed"], 5);
  EXPECT_EQ(stats["options"]["environment"], json({1.0, 1.0, 1.0}));
}

TEST_F(RenderCommand, StatisticsAreTheOnlyOutputOnStdout) {
  const Output output = render({"-o", path("a.png"), "--stats", "-"});
  EXPECT_EQ(output.exit_code, 0);
  EXPECT_EQ(json::parse(output.out)["spp"], 4);
}

TEST_F(RenderCommand, TheRecipeIsInTheHeader) {
  ASSERT_EQ(render({"-o", path("a.exr"), "--seed", "9", "--quiet"}).exit_code, 0);
  const std::map<std::string, std::string> recipe = read_image(path("a.exr")).metadata;
  for (const char* key :
       {"version", "command", "seed", "spp", "integrator", "isa", "options", "threads", "seconds"}) {
    EXPECT_EQ(recipe.count(key), 1u) << key;
  }
  EXPECT_EQ(recipe.at("seed"), "9");
  EXPECT_EQ(recipe.at("spp"), "4");
  EXPECT_EQ(recipe.at("integrator"), "path");
  EXPECT_THAT(recipe.at("command"), HasSubstr("--seed 9"));
  EXPECT_EQ(json::parse(recipe.at("options"))["max-depth"], 8);
}

TEST_F(RenderCommand, ReproducibleFilesAreEqualForAnyNumberOfThreads) {
  ASSERT_EQ(render({"-o", path("a.exr"), "--reproducible", "--quiet", "--threads", "1"}).exit_code, 0);
  ASSERT_EQ(render({"-o", path("b.exr"), "--reproducible", "--quiet", "--threads", "2"}).exit_code, 0);
  ASSERT_EQ(render({"-o", path("c.exr"), "--reproducible", "--quiet", "--seed", "1"}).exit_code, 0);
  EXPECT_EQ(read_file(path("a.exr")), read_file(path("b.exr")));
  EXPECT_NE(read_image(path("a.exr")).layers[0].values, read_image(path("c.exr")).layers[0].values);
}

TEST_F(RenderCommand, ARegionIsThePartOfTheFullPicture) {
  ASSERT_EQ(render({"-o", path("full.exr"), "--exr", "float", "--quiet"}).exit_code, 0);
  ASSERT_EQ(render({"-o", path("part.exr"), "--exr", "float", "--quiet", "--region", "9,4,14,7"}).exit_code,
            0);
  const Picture full = read_image(path("full.exr"));
  const Picture part = read_image(path("part.exr"));
  EXPECT_EQ(part.width, 5);
  EXPECT_EQ(part.height, 3);
  EXPECT_EQ(part.x0, 9);
  EXPECT_EQ(part.y0, 4);
  EXPECT_EQ(part.full_width, 24);
  EXPECT_EQ(part.full_height, 16);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 15; ++x) {
      EXPECT_EQ(part.layers[0].values[static_cast<std::size_t>(y * 15 + x)],
                full.layers[0].values[static_cast<std::size_t>((y + 4) * 72 + 27 + x)]);
    }
  }
}

TEST_F(RenderCommand, AllLayersAreInTheExr) {
  ASSERT_EQ(render({"-o", path("a.exr"), "--aov", "all", "--quiet"}).exit_code, 0);
  const Picture picture = read_image(path("a.exr"));
  for (const char* name :
       {"albedo", "normal", "depth", "position", "primitive", "instance", "samples", "variance"}) {
    EXPECT_NE(picture.find(name), nullptr) << name;
  }
}

TEST_F(RenderCommand, CryptomattesAreInTheExrAndStayWhenItIsMergedAndDenoised) {
  GATELIGHT_NEEDS_DENOISER();
  for (const char* seed : {"1", "2"}) {
    const Output output = render({"-o", path(fmt::format("{}.exr", seed)), "--cryptomatte", "material,object",
                                  "--seed", seed, "--aov", "denoising", "--stats", "-"});
    ASSERT_EQ(output.exit_code, 0) << output.err;
    EXPECT_THAT(output.err, HasSubstr(", cryptomatte 0."));
    const json stats = json::parse(output.out);
    EXPECT_EQ(stats["options"]["cryptomatte"], json({"object", "material"}));
    EXPECT_GT(stats["seconds"]["cryptomatte"], 0.0);
  }
  ASSERT_EQ(run_gatelight({"merge", path("1.exr"), path("2.exr"), "-o", path("m.exr")}).exit_code, 0);
  ASSERT_EQ(run_gatelight({"denoise", path("m.exr"), "-o", path("r.exr")}).exit_code, 0);
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
  const Output output = render({"-o", path("a.png"), "--cryptomatte", "object"});
  EXPECT_EQ(output.exit_code, 0);
  expect_messages(output.warnings(), {{"--cryptomatte", ".exr"}});
}

TEST_F(RenderCommand, AmbientOcclusionOfAnOpenSquareIsOne) {
  ASSERT_EQ(render({"-o", path("a.exr"), "--integrator", "ao", "--ao-distance", "inf", "--quiet"}).exit_code,
            0);
  const Picture picture = read_image(path("a.exr"));
  EXPECT_FLOAT_EQ(picture.layers[0].values[3 * (8 * 24 + 12)], 1.0f);
}

TEST_F(RenderCommand, ATimeLimitEndsTheRunWithCode0) {
  const Output output =
      render({"-o", path("a.png"), "--spp", "16777216", "--time-limit", "0.3", "--stats", "-"});
  EXPECT_EQ(output.exit_code, 0) << output.err;
  const json stats = json::parse(output.out);
  EXPECT_EQ(stats["interrupted"], true);
  EXPECT_GE(stats["spp"], 1);
}

TEST_F(RenderCommand, ATimeLimitDecidesHowManySamplesAPresetHas) {
  for (const char* preset : {"preview", "standard", "final"}) {
    SCOPED_TRACE(preset);
    const Output output =
        render_open({"-o", path("a.exr"), "--preset", preset, "--time-limit", "0.5", "--stats", "-"});
    EXPECT_EQ(output.exit_code, 0) << output.err;
    const json stats = json::parse(output.out);
    EXPECT_EQ(stats["ended_by"], "time-limit");
    EXPECT_GE(stats["spp"], 1);
    const Output few = render({"-o", path("a.exr"), "--preset", preset, "--time-limit", "100", "--spp", "2",
                               "--train-steps", "1", "--stats", "-"});
    EXPECT_EQ(few.exit_code, 0) << few.err;
    EXPECT_EQ(json::parse(few.out)["spp"], 2) << "a given number is a limit too";
    EXPECT_EQ(json::parse(few.out)["train"]["steps"], 1);
    EXPECT_EQ(json::parse(few.out)["ended_by"], "spp");
  }
}

TEST_F(RenderCommand, TheEstimatedErrorIsInSummaryStatisticsAndRecipe) {
  const Output output = render({"-o", path("a.exr"), "--spp", "4", "--stats", path("s.json")});
  ASSERT_EQ(output.exit_code, 0) << output.err;
  EXPECT_THAT(output.err, HasSubstr("; estimated error "));
  EXPECT_TRUE(json::parse(read_file(path("s.json")))["estimated_error"].is_number());
  EXPECT_TRUE(read_image(path("a.exr")).metadata.contains("estimated_error"));
  const Output one = render({"-o", path("a.exr"), "--spp", "1", "--stats", path("s.json")});
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_THAT(one.err, Not(HasSubstr("estimated error")));
  EXPECT_FALSE(json::parse(read_file(path("s.json"))).contains("estimated_error"));
  EXPECT_FALSE(read_image(path("a.exr")).metadata.contains("estimated_error"));
}

TEST_F(RenderCommand, AnErrorThatIsNotReachedIsReported) {
  const Output reached = render_open({"-o", path("a.png"), "--max-error", "1000", "--stats", path("s.json")});
  ASSERT_EQ(reached.exit_code, 0) << reached.err;
  EXPECT_THAT(reached.err, Not(HasSubstr("ended it first")));
  const json stats = json::parse(read_file(path("s.json")));
  EXPECT_EQ(stats["ended_by"], "max-error");
  EXPECT_EQ(stats["spp"], 4) << "of the first check";
  EXPECT_EQ(stats["interrupted"], false);
  const Output missed = render({"-o", path("a.png"), "--max-error", "1e-9", "--spp", "8"});
  ASSERT_EQ(missed.exit_code, 0) << missed.err;
  EXPECT_THAT(missed.err, HasSubstr("--spp ended it first"));
}

TEST_F(RenderCommand, APresetFindsTheExposureOfItsPngAndReportsIt) {
  const std::vector<std::string> preset = {"--preset", "preview", "--spp", "2", "--train-steps", "1"};
  const auto exposed = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = preset;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return render_open(arguments);
  };
  const Output found = exposed({"-o", path("auto.png"), "--stats", path("auto.json")});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  const double stops = json::parse(read_file(path("auto.json")))["exposure"];
  EXPECT_NE(stops, 0.0);
  EXPECT_THAT(found.err, HasSubstr(fmt::format("--exposure {:.1f} keeps it", stops)));
  const Output kept = exposed({"-o", path("kept.png"), "--exposure", fmt::format("{:.1f}", stops)});
  EXPECT_EQ(read_file(path("auto.png")), read_file(path("kept.png")));
  EXPECT_THAT(kept.err, Not(HasSubstr("exposure")));
  // Without a preset the radiance does not change.
  EXPECT_THAT(render_open({"-o", path("plain.png")}).err, Not(HasSubstr("exposure")));
}

TEST_F(RenderCommand, APictureThatIsFarTooBrightForAScreenIsReported) {
  const auto lit = [&](const char* scale, std::vector<std::string> more) {
    more.insert(more.end(), {"--environment-scale", scale, "-o", path("a.exr"), "--spp", "1"});
    return render_open(more).err;
  };
  const char* const warning = "stops too bright for a screen";
  EXPECT_THAT(lit("1000", {"-o", path("a.png")}), AllOf(HasSubstr(warning), HasSubstr("--exposure -")));
  EXPECT_THAT(lit("1000", {}), Not(HasSubstr(warning))) << "an EXR stores any radiance";
  EXPECT_THAT(lit("1000", {"-o", path("a.png"), "--exposure", "0"}), Not(HasSubstr(warning)));
  EXPECT_THAT(lit("1", {"-o", path("a.png")}), Not(HasSubstr(warning)));
}

TEST_F(RenderCommand, SamplesThatAreNotFiniteAreLocatedOrStopTheRun) {
  // The square and its twin light each other, and the sum of emitted and reflected light overflows.
  nlohmann::json hot = json::parse(tiny_scene());
  hot["extensionsUsed"] = {"KHR_materials_emissive_strength"};
  hot["materials"][0]["emissiveFactor"] = {1, 1, 1};
  hot["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 3.4e38;
  hot["nodes"].push_back(
      {{"mesh", 0}, {"rotation", {0, -0.70710678, 0, 0.70710678}}, {"translation", {1, 0, 1}}});
  hot["scenes"][0]["nodes"].push_back(2);
  scene = folder.write("hot.gltf", hot.dump());
  const std::vector<std::string> flags = {"-o", path("a.exr"), "--size", "24x16", "--spp", "4"};
  std::vector<std::string> dropping = {"render", scene, "--stats", "-"};
  dropping.insert(dropping.end(), flags.begin(), flags.end());
  const Output dropped = run_gatelight(dropping);
  EXPECT_EQ(dropped.exit_code, 0) << dropped.err;
  const json stats = json::parse(dropped.out);
  EXPECT_GT(stats["nonfinite"]["count"], 0);
  EXPECT_THAT(keys(stats["nonfinite"]["samples"][0]), UnorderedElementsAre("x", "y", "sample", "seed"));
  EXPECT_EQ(dropped.warnings().size(), 1u) << dropped.err;
  const Picture picture = read_image(path("a.exr"));
  for (const float value : picture.layers[0].values) EXPECT_TRUE(std::isfinite(value));

  std::filesystem::remove(path("a.exr"));
  std::vector<std::string> stopping = {"render", scene, "--nan", "error"};
  stopping.insert(stopping.end(), flags.begin(), flags.end());
  const Output stopped = run_gatelight(stopping);
  expect_failure_names(stopped, 6, {"hot.gltf", "pixel", "--nan drop"});
  EXPECT_FALSE(std::filesystem::exists(path("a.exr")));
}

TEST_F(RenderCommand, AnInstructionSetThatIsMissingIsCode5) {
  const std::string best = json::parse(run_gatelight({"info", "--json", "-"}).out)["isa"];
  if (best == "avx512") GTEST_SKIP() << "this machine has them all";
  const Output output = render({"-o", path("a.exr"), "--isa", "avx512"});
  expect_failure_names(output, 5, {"avx512", "--isa auto"});  // and those of this machine
}

TEST_F(RenderCommand, ProgressLinesAreJson) {
  const Output output = render({"-o", path("a.png"), "--progress", "json"});
  EXPECT_EQ(output.exit_code, 0);
  std::istringstream lines(output.err);
  std::set<std::string> events;
  double last_fraction = 0.0;
  for (std::string line; std::getline(lines, line);) {
    const json object = json::parse(line);
    events.insert(object["event"]);
    if (object["event"] != "progress") continue;
    for (const char* key : {"fraction", "spp_done", "spp", "seconds", "samples_per_second"}) {
      EXPECT_TRUE(object[key].is_number()) << key;
    }
    EXPECT_EQ(object["phase"], "render");
    EXPECT_GE(object["fraction"], last_fraction);
    last_fraction = object["fraction"];
  }
  EXPECT_THAT(events, UnorderedElementsAre("phase", "progress", "done"));
}

TEST_F(RenderCommand, TheProgressBarIsShownOnlyOnRequest) {
  EXPECT_THAT(render({"-o", path("a.png"), "--progress", "bar"}).err,
              AllOf(HasSubstr("spp"), HasSubstr("ETA")));
  EXPECT_THAT(render({"-o", path("a.png")}).err, ::testing::Not(HasSubstr("ETA")));
}

TEST_F(RenderCommand, WarningsGoToStderrAndIntoTheStatistics) {
  std::string text = tiny_scene();
  text.insert(1, R"("extensionsUsed": ["EXT_of_another_{}_world"],)");
  scene = folder.write("warn.gltf", text);
  const Output output = render({"-o", path("a.png"), "--stats", "-"});
  EXPECT_EQ(output.exit_code, 0) << output.err;
  expect_messages(output.warnings(), {{"EXT_of_another_{}_world"}});
  expect_messages(json::parse(output.out)["warnings"], {{"EXT_of_another_{}_world"}});
}

TEST_F(RenderCommand, ASceneReadsNothingOutsideItsFolderUnlessThatIsAllowed) {
  json gltf = json::parse(tiny_scene());
  const float corners[18] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, -1, 0, 1, 1, 0, -1, 1, 0};
  folder.write("scene.bin", std::string(reinterpret_cast<const char*>(corners), sizeof(corners)));
  gltf["buffers"][0]["uri"] = "%2e%2e/scene.bin";
  const std::string inner = folder.write("inner/scene.gltf", gltf.dump());
  const std::vector<std::string> render = {"render", inner, "-o",     path("a.png"),
                                           "--spp",  "1",   "--size", "8x8"};
  for (std::vector<std::string> call : {render, {"info", inner}, {"sweep", inner, "-o", path("sweep")}}) {
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
  const Output text = run_gatelight({"info", scene});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  for (const char* word : {"triangles", "2 stored", "front", "bounds", "requires", "memory"}) {
    EXPECT_THAT(text.out, HasSubstr(word));
  }
  std::string odd = tiny_scene();
  odd.replace(odd.rfind("\"front\", \"type\""), 7, R"("a\n\u001b]0;b")");
  const Output description = run_gatelight_inside({"info", folder.write("odd.gltf", odd)});
  EXPECT_EQ(description.exit_code, 0) << description.err;
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

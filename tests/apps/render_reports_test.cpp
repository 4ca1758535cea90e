// Reports of real renders: statistics, recipe, summary, progress and warnings; and how a run ends.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/image/image_read.h"
#include "tests/apps/render_command.h"
#include "tests/support/picture_files.h"

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

class RenderReports : public SquareRenders {};

TEST_F(RenderReports, StatisticsHoldEveryKeyOfTheSchema) {
  const Output output = expect_done(render({"-o", path("a.exr"), "--stats", path("s.json"), "--seed", "5"}));
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
  EXPECT_EQ(stats["clamped"], 0);
  EXPECT_EQ(stats["options"]["seed"], 5);
  EXPECT_EQ(stats["options"]["environment"], json({1.0, 1.0, 1.0}));
}

TEST_F(RenderReports, TheEstimatedErrorIsInSummaryStatisticsAndRecipe) {
  const Output output = expect_done(render({"-o", path("a.exr"), "--spp", "4", "--stats", path("s.json")}));
  EXPECT_THAT(output.err, HasSubstr("; estimated error "));
  EXPECT_TRUE(json::parse(read_file(path("s.json")))["estimated_error"].is_number());
  EXPECT_TRUE(read_image(path("a.exr")).metadata.contains("estimated_error"));
  const Output one = expect_done(render({"-o", path("a.exr"), "--spp", "1", "--stats", path("s.json")}));
  EXPECT_THAT(one.err, Not(HasSubstr("estimated error")));
  EXPECT_FALSE(json::parse(read_file(path("s.json"))).contains("estimated_error"));
  EXPECT_FALSE(read_image(path("a.exr")).metadata.contains("estimated_error"));
}

TEST_F(RenderReports, AnErrorThatIsNotReachedIsReported) {
  const Output reached =
      expect_done(render_open({"-o", path("a.png"), "--max-error", "1000", "--stats", path("s.json")}));
  EXPECT_THAT(reached.err, Not(HasSubstr("ended it first")));
  const json stats = json::parse(read_file(path("s.json")));
  EXPECT_EQ(stats["ended_by"], "max-error");
  EXPECT_EQ(stats["spp"], 4) << "of the first check";
  EXPECT_EQ(stats["interrupted"], false);
  const Output missed = expect_done(render({"-o", path("a.png"), "--max-error", "1e-9", "--spp", "8"}));
  EXPECT_THAT(missed.err, HasSubstr("--spp ended it first"));
}

TEST_F(RenderReports, APresetFindsTheExposureOfItsPngAndReportsIt) {
  const auto exposed = [&](const Words& more) {
    return render_open(words_of("--preset preview --spp 2 --train-steps 1", {}, more));
  };
  const Output found = expect_done(exposed({"-o", path("auto.png"), "--stats", path("auto.json")}));
  const double stops = json::parse(read_file(path("auto.json")))["exposure"];
  EXPECT_NE(stops, 0.0);
  EXPECT_THAT(found.err, HasSubstr(fmt::format("--exposure {:.1f} sets the same", stops)));
  const Output kept = exposed({"-o", path("kept.png"), "--exposure", fmt::format("{:.1f}", stops)});
  EXPECT_EQ(read_file(path("auto.png")), read_file(path("kept.png")));
  EXPECT_THAT(kept.err, Not(HasSubstr("exposure")));
  // Without a preset the radiance does not change.
  EXPECT_THAT(render_open({"-o", path("plain.png")}).err, Not(HasSubstr("exposure")));
}

TEST_F(RenderReports, APictureThatIsFarTooBrightForAScreenIsReported) {
  const auto lit = [&](const char* scale, const Words& more) {
    return render_open(words_of("--environment-scale {} -o {} --spp 1", {scale, path("a.exr")}, more)).err;
  };
  const char* const warning = "of the pixels are clipped to white";
  EXPECT_THAT(lit("1000", {"-o", path("a.png")}), AllOf(HasSubstr(warning), HasSubstr("--exposure -")));
  EXPECT_THAT(lit("1000", {}), Not(HasSubstr(warning))) << "an EXR stores any radiance";
  EXPECT_THAT(lit("1000", {"-o", path("a.png"), "--exposure", "0"}), Not(HasSubstr(warning)));
  EXPECT_THAT(lit("1", {"-o", path("a.png")}), Not(HasSubstr(warning))) << "a white picture";
  EXPECT_THAT(lit("1000", {"-o", path("a.png")}), Not(HasSubstr("watts"))) << "no lamp";
}

TEST_F(RenderReports, LampsInWattsAreNamedWhereTheyAreTheReason) {
  const auto warnings_of = [&](double intensity, const char* lights, const json& more = json::object()) {
    json lit = json::parse(tiny_scene());
    add_light(lit, {{"name", "lamp"}, {"type", "point"}, {"intensity", intensity}},
              {{"translation", {0, 0, 2}}});
    lit["materials"][0].update(more);
    return expect_done(
               run_gatelight(words_of("render {} -o {} --size 24x16 --spp 4 --environment none --lights {}",
                                      {folder.write("lit.gltf", lit.dump()), path("a.png"), lights})))
        .warnings();
  };
  // Blender writes a lamp of 200 W as 200 W * 683 lm/W / (4 pi) = 10870 cd.
  expect_messages(warnings_of(10870, "lamp=1"),
                  {{"clipped to white", "--exposure -", "683", "--lights '*=0.00146'"}});
  EXPECT_THAT(warnings_of(10870, "lamp=0.00146"), ::testing::IsEmpty()) << "the advice helps";
  EXPECT_THAT(warnings_of(15.9, "lamp=1"), ::testing::IsEmpty());
  expect_messages(warnings_of(10870, "lamp=1", {{"emissiveFactor", {1, 1, 1}}}),
                  {{"clipped to white", "--lights 'lamp=0.00146'"}});
}

TEST_F(RenderReports, ValuesBeyondHalfAreCountedByLayer) {
  nlohmann::json lamp = json::parse(tiny_scene());
  lamp["extensionsUsed"] = {"KHR_materials_emissive_strength"};
  lamp["materials"][0]["emissiveFactor"] = {1, 1, 0};
  lamp["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 1e6;
  scene = folder.write("lamp.gltf", lamp.dump());
  const Output half = expect_done(render({"-o", path("a.exr"), "--stats", "-"}));
  const Picture picture = read_image(path("a.exr"));
  const std::vector<float>& values = picture.layers[0].values;
  const auto count = std::count(values.begin(), values.end(), 65504.0f);
  EXPECT_GT(count, 0);
  for (const float value : values) EXPECT_TRUE(std::isfinite(value));
  const std::string beauty = fmt::format("{} in the picture", count);
  expect_messages(half.warnings(), {{"65504", beauty, "--exr float"}});
  expect_messages(json::parse(half.out)["warnings"], {{"65504", beauty, "--exr float"}});
  const auto no_warning = [&](Words flags) { EXPECT_THAT(render(flags).err, Not(HasSubstr("65504"))); };
  no_warning({"-o", path("a.exr"), "--exr", "float"});
  EXPECT_GE(beauty_of(path("a.exr"))[3 * (8 * 24 + 12)], 1e6f);
  no_warning({"-o", path("a.hdr")});
  EXPECT_THAT(render({"-o", "exr:-"}).err, HasSubstr("65504"));
}

TEST_F(RenderReports, SamplesThatAreNotFiniteAreLocatedOrStopTheRun) {
  // The square and its twin light each other, and the sum of emitted and reflected light overflows.
  nlohmann::json hot = json::parse(tiny_scene());
  hot["extensionsUsed"] = {"KHR_materials_emissive_strength"};
  hot["materials"][0]["emissiveFactor"] = {1, 1, 1};
  hot["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 3.4e38;
  hot["nodes"].push_back(
      {{"mesh", 0}, {"rotation", {0, -0.70710678, 0, 0.70710678}}, {"translation", {1, 0, 1}}});
  hot["scenes"][0]["nodes"].push_back(2);
  scene = folder.write("hot.gltf", hot.dump());
  const auto run = [&](const Words& more) {
    return run_gatelight(
        words_of("render {} -o {} --exr float --size 24x16 --spp 4", {scene, path("a.exr")}, more));
  };
  const Output dropped = expect_done(run({"--stats", "-"}));
  const json stats = json::parse(dropped.out);
  EXPECT_GT(stats["nonfinite"]["count"], 0);
  EXPECT_THAT(keys(stats["nonfinite"]["samples"][0]), UnorderedElementsAre("x", "y", "sample", "seed"));
  EXPECT_EQ(dropped.warnings().size(), 1u) << dropped.err;
  const Picture picture = read_image(path("a.exr"));
  for (const float value : picture.layers[0].values) EXPECT_TRUE(std::isfinite(value));

  std::filesystem::remove(path("a.exr"));
  expect_failure(run({"--nan", "error"}), 6, {"hot.gltf", "pixel", "--nan drop"});
  EXPECT_FALSE(std::filesystem::exists(path("a.exr")));
}

TEST_F(RenderReports, TheProgressBarIsShownOnlyOnRequest) {
  EXPECT_THAT(render({"-o", path("a.png"), "--progress", "bar"}).err,
              AllOf(HasSubstr("spp"), HasSubstr("ETA")));
  EXPECT_THAT(render({"-o", path("a.png")}).err, ::testing::Not(HasSubstr("ETA")));
}

TEST_F(RenderReports, WarningsGoToStderrAndIntoTheStatistics) {
  std::string text = tiny_scene();
  text.insert(1, R"("extensionsUsed": ["EXT_of_another_{}_world"],)");
  scene = folder.write("warn.gltf", text);
  const Output output = expect_done(render({"-o", path("a.png"), "--stats", "-"}));
  expect_messages(output.warnings(), {{"EXT_of_another_{}_world"}});
  expect_messages(json::parse(output.out)["warnings"], {{"EXT_of_another_{}_world"}});
}

TEST_F(RenderReports, QuietPrintsNothing) {
  const Output output = expect_done(render({"-o", path("a.png"), "--quiet", "--progress", "json"}));
  EXPECT_EQ(output.out, "");
  EXPECT_EQ(output.err, "");
}

TEST_F(RenderReports, ATimeLimitDecidesHowManySamplesAPresetHas) {
  for (const char* preset : {"preview", "standard", "final"}) {
    SCOPED_TRACE(preset);
    const Output output = expect_done(
        render_open({"-o", path("a.exr"), "--preset", preset, "--time-limit", "0.5", "--stats", "-"}));
    const json stats = json::parse(output.out);
    EXPECT_EQ(stats["ended_by"], "time-limit");
    EXPECT_GE(stats["spp"], 1);
    const Output few = expect_done(render({"-o", path("a.exr"), "--preset", preset, "--time-limit", "100",
                                           "--spp", "2", "--train-steps", "1", "--stats", "-"}));
    EXPECT_EQ(json::parse(few.out)["spp"], 2) << "a given number is a limit too";
    EXPECT_EQ(json::parse(few.out)["train"]["steps"], 1);
    EXPECT_EQ(json::parse(few.out)["ended_by"], "spp");
  }
}

}  // namespace
}  // namespace gatelight::tests

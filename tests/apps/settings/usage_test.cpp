// The command line as a user meets it: help, refusals, exit codes and the last line on stderr.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "tests/support/folder_test.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class Usage : public FolderTest {
 protected:
  std::string scene() const { return folder.write("scene.gltf", tiny_scene()); }
  /// Runs a render of the tiny scene that must be refused. It runs in this process, because there are many
  /// and the program starts slowly.
  Output refused(const Words& flags) const {
    const Output output = run_gatelight_inside(words_of("render {} -o {}", {scene(), path("a.png")}, flags));
    EXPECT_EQ(output.out, "");
    EXPECT_FALSE(std::filesystem::exists(path("a.png")));
    return output;
  }
};

TEST_F(Usage, HelpFitsOnTwoScreens) {
  const Output help = expect_done(run_gatelight({"render", "--help"}));
  std::istringstream text(help.out);
  int lines = 0;
  for (std::string line; std::getline(text, line); ++lines) EXPECT_LE(line.size(), 120u) << line;
  EXPECT_LE(lines, 100);
  for (const char* word : {"--output", "--spp", "--preset", "--camera", "--help-all", "W/sr", "Examples:"})
    EXPECT_THAT(help.out, HasSubstr(word));
  for (const char* word : {"--hash-levels", "--region", "--isa"}) EXPECT_THAT(help.out, Not(HasSubstr(word)));
  EXPECT_EQ(run_gatelight_inside({"render", scene(), "--help"}).out, help.out) << "a scene is no topic";
}

TEST_F(Usage, HelpOfATopicHasAllOfItsFlagsAndNoOthers) {
  const Output cache = expect_done(run_gatelight_inside({"render", "--help", "cache"}));
  for (const char* word : {"--train-steps", "--hash-levels", "--query-at", "--self-training-full"})
    EXPECT_THAT(cache.out, HasSubstr(word));
  for (const char* word : {"--spp", "--camera", "--isa", "Examples:"})
    EXPECT_THAT(cache.out, Not(HasSubstr(word)));
  EXPECT_THAT(run_gatelight_inside({"render", "--help", "view"}).out,
              AllOf(HasSubstr("--projection"), Not(HasSubstr("--train-steps"))));
}

TEST_F(Usage, HelpGoesToStdoutAndNamesValuesAndDefaults) {
  const Output root = expect_done(run_gatelight({"--help"}));
  EXPECT_EQ(root.err, "");
  for (const char* word : {"render", "compare", "info", "merge", "sweep", "--config", "Exit codes"})
    EXPECT_THAT(root.out, HasSubstr(word));
  EXPECT_THAT(run_gatelight_inside({"render", "--help-all"}).out,
              AllOf(StartsWith("Render a scene"), HasSubstr("--integrator path|ao|nao|nrc"),
                    HasSubstr("[960x540]"), HasSubstr("--query-at primary|gather|spread|none")));
  EXPECT_THAT(run_gatelight_inside({"info", "--help-all"}).out,
              AllOf(HasSubstr("--stack LIST"), HasSubstr("[warn]")));
  EXPECT_THAT(run_gatelight_inside({"compare", "--help"}).out, HasSubstr("rel_mse"));
}

TEST_F(Usage, VersionNamesProgramAndDenoiserOnStdout) {
  const Output output = expect_done(run_gatelight({"--version"}));
  EXPECT_THAT(output.out,
              ::testing::MatchesRegex("gatelight [0-9]+[.][0-9]+[.][0-9]+[^\n]*\ndenoiser: [^\n]*\n"));
}

TEST_F(Usage, AMissingOrUnknownSubcommandIsCode1) {
  for (const Words& arguments : {std::vector<std::string>{}, std::vector<std::string>{"frobnicate"},
                                 std::vector<std::string>{"--frob"}}) {
    const Output output = run_gatelight_inside(arguments);
    expect_failure(output, 1, {"--help"});
    EXPECT_EQ(output.out, "");
  }
  expect_failure(run_gatelight({"frobnicate"}), 1, {"frobnicate"});
}

TEST_F(Usage, UnknownFlagsAreRefusedByName) {
  for (const char* flag : {"--frob", "--check", "--ssp=4", "-z"}) {
    const Output output = refused({flag});
    expect_failure(output, 1, {flag});
  }
}

struct Misspelt {
  Words arguments;
  const char* meant;  ///< empty: no name is near
};

TEST_F(Usage, TheNearestNameIsSuggested) {
  const std::string config = folder.write("c.toml", "expsure = 1\n");
  const std::vector<Misspelt> cases = {
      {{"render", scene(), "-o", "a.png", "--aperure", "3"}, "--aperture"},
      {{"render", scene(), "-o", "a.png", "--aperure=3"}, "--aperture"},
      {{"render", scene(), "--outptu", "a.png"}, "--output"},
      {{"render", scene(), "-o", "a.png", "--frob"}, ""},
      {{"render", scene(), "-o", "a.png", "--config", config}, "exposure"},
      {{"render", scene(), "-o", "a.png", "--sampler", "sobl"}, "sobol"},
      {{"render", scene(), "-o", "a.png", "--sampler", "halton"}, ""},
      {{"render", scene(), "-o", "a.png", "--aov", "depth,nromal"}, "normal"},
      {{"render", scene(), "-o", path("a.png"), "--camera", "fornt"}, "front"},
      {{"rendr", scene()}, "render"},
      {{"frobnicate"}, ""},
  };
  for (const auto& [arguments, meant] : cases) {
    const Output output = run_gatelight_inside(arguments);
    expect_failure(output, 1, {});
    if (meant[0] != '\0') {
      EXPECT_THAT(output.err, HasSubstr(fmt::format("did you mean '{}'?", meant)));
    } else {
      EXPECT_THAT(output.err, Not(HasSubstr("did you mean")));
    }
  }
}

struct BadValue {
  Words flags;
  NameList names;
};

const std::vector<BadValue> kBadValues = {
    {{"--spp", "0"}, {"--spp", "0", "1"}},
    {{"--size", "0x10"}, {"--size", "0x10", "1", "65536"}},
    {{"--size", "65536x65536"}, {"--size", "65536x65536"}},
    {{"--fov", "180"}, {"--fov", "180", "0.001", "179.9"}},
    {{"--eye", "1e20,0,0", "--target", "0,0,0"}, {"--eye", "1e+20", "1e+12"}},
    {{"--clamp", "1e-41"}, {"--clamp", "1e-41", "0", "1.18e-38"}},
    {{"--checkpoint", ""}, {"--checkpoint", "''", "FILE"}},
    {{"--stats", ""}, {"--stats", "''", "FILE|-"}},
    {{"--environment", ""}, {"--environment", "''", "auto|none|r,g,b|FILE"}},
    {{"--camera", ""}, {"--camera", "''", "NAME|INDEX"}},
    {{"-o", ""}, {"--output", "''", "FILE"}},
    {{"--config", ""}, {"--config", "''", "FILE.toml"}},
    {{"--time-limit", "-1"}, {"--time-limit", "-1", "0"}},
    {{"--max-error", "-0.1"}, {"--max-error", "-0.1", "0"}},
    {{"--region", "0,0,961,1"}, {"--region", "0,0,961,1", "960"}},
    {{"--seed", "4294967296"}, {"--seed", "4294967296", "4294967295"}},
    {{"--max-depth", "-1"}, {"--max-depth", "-1", "0"}},
    {{"--threads", "-2"}, {"--threads", "-2", "0"}},
    {{"--exposure", "inf"}, {"--exposure", "inf", "-100", "100"}},
    {{"--clamp", "-0.5"}, {"--clamp", "-0.5", "0"}},
    {{"--ao-distance", "0"}, {"--ao-distance", "0", "inf"}},
    {{"--integrator", "nrc2"}, {"--integrator", "nrc2", "path|ao"}},
    {{"--isa", "sse9"}, {"--isa", "sse9", "auto|scalar|avx2|avx512"}},
    {{"--aov", "albedo,beauty"}, {"--aov", "beauty", "albedo|normal"}},
    {{"--cryptomatte", "object,asset"}, {"--cryptomatte", "asset", "object|material"}},
    {{"--environment", "1,-2,3"}, {"--environment", "1,-2,3", "0"}},
    {{"--sky", "clear", "--environment", "auto"}, {"--sky", "environment"}},
    {{"--lights", "lamp"}, {"--lights", "lamp", "NAME=off"}},
    {{"--lights", "lamp=-1"}, {"--lights", "-1", "0"}},
    {{"--lights", "lamp=1,2"}, {"--lights", "1,2"}},
    {{"--lights", "lamp=off;"}, {"--lights", "''", "NAME=off"}},
    {{"--visibility", "wall=camera:no"}, {"--visibility", "no", "on|off|only"}},
    {{"--light-links", "key=receivers"}, {"--light-links", "key=receivers", "LIGHT=receivers:NODE+NODE"}},
    {{"--light-groups", "key"}, {"--light-groups", "key", "NAME=LIGHT"}},
    {{"--eye", "1,2", "--target", "0,0,0"}, {"--eye", "1,2"}},
    {{"--eye", "1,2,3"}, {"--target", "eye"}},
    {{"--eye", "1,2,3", "--target", "1,2,3"}, {"--target", "1,2,3"}},
    {{"--eye", "0,1,0", "--target", "0,5,0"}, {"--up", "0,1,0"}},
    {{"--camera", "none such"}, {"camera", "none such", "front"}},
    {{"--progress", "loud"}, {"--progress", "loud", "auto|bar|json|none"}},
    {{"--quiet", "--verbose"}, {"--quiet", "verbose"}},
    {{"--train-steps", "-1"}, {"--train-steps", "-1", "0"}},
    {{"--batch", "0"}, {"--batch", "0", "1"}},
    {{"--self-training", "on"}, {"--self-training", "on"}},
    {{"--self-training-full", "1.5"}, {"--self-training-full", "1.5", "1"}},
    {{"--features", "17"}, {"--features", "17", "1", "16"}},
    {{"--stack", "adaptive,65"}, {"--stack", "65", "1", "64"}},
    {{"--stack", "1,2,3,4,5"}, {"--stack", "1,2,3,4,5", "4"}},
    {{"--stack", "adaptive,"}, {"--stack", "adaptive,"}},
    {{"--resolution", "fixed:0"}, {"--resolution", "0", "1", "64"}},
    {{"--resolution", "fixed"}, {"--resolution", "fixed", "uniform|paper|fixed:R"}},
    {{"--node-spacing", "0"}, {"--node-spacing", "0"}},
    {{"--cache-memory", "-1"}, {"--cache-memory", "-1", "0"}},
    {{"--hash-log2-size", "32"}, {"--hash-log2-size", "32", "3", "31"}},
    {{"--hash-growth", "0.5"}, {"--hash-growth", "0.5", "1"}},
    {{"--hidden", "48"}, {"--hidden", "48", "16|32|64|128"}},
    {{"--layers", "6"}, {"--layers", "6", "1", "5"}},
    {{"--bias", "yes"}, {"--bias", "yes", "on|off"}},
    {{"--learning-rate", "nan"}, {"--learning-rate", "nan", "0"}},
    {{"--cache-roughness", "2"}, {"--cache-roughness", "2", "1"}},
    {{"--device", "gpu"}, {"--device", "gpu", "cpu|vulkan"}},
    {{"--device", "vulkan:"}, {"--device", "vulkan:", "INDEX"}},
    {{"--preset", "fast"}, {"--preset", "fast", "bare|preview|standard|final|paper-nao|paper-nrc"}},
    {{"--checkpoint-every", "-1"}, {"--checkpoint-every", "-1", "0"}},
    {{"--spp"}, {"--spp"}},
    {{"--spp", "1", "--spp", "2"}, {"--spp", "2"}},
};

TEST_F(Usage, BadValuesAreCode1AndNameFlagValueAndExpectation) {
  for (const BadValue& bad : kBadValues) expect_failure(refused(bad.flags), 1, bad.names);
}

TEST_F(Usage, AnOutputIsRequiredAndItsExtensionKnown) {
  EXPECT_EQ(run_gatelight({"render", scene()}).exit_code, 1);
  const Output output = run_gatelight({"render", scene(), "-o", path("a.gif")});
  expect_failure(output, 1, {"a.gif", ".exr", ".png"});
  EXPECT_EQ(refused({"-o", path("a.png")}).exit_code, 1);
}

TEST_F(Usage, UnusableInputsAreCode2AndNamed) {
  folder.write("empty.gltf", "");
  folder.write("text.glb", "this is no scene");
  folder.write("version.gltf", R"({"asset": {"version": "1.0"}})");
  for (const char* name : {"missing.gltf", "empty.gltf", "text.glb", "version.gltf", "."}) {
    const Output output = run_gatelight({"render", path(name), "-o", path("a.png")});
    expect_failure(output, 2, {path(name)});
    EXPECT_EQ(run_gatelight({"info", path(name)}).exit_code, 2);
  }
  folder.write("broken.exr", "this is no picture");
  for (const char* name : {"missing.exr", "broken.exr", "missing.hdr"}) {
    const Output output = refused({"--environment", path(name)});
    expect_failure(output, 2, {path(name)});
  }
  expect_failure(refused({"--lights", "lamp=off"}), 2, {"scene.gltf", "lamp", "none"});
  const Output cache = refused({"--integrator", "nrc", "--cache-in", path("missing.safetensors")});
  expect_failure(cache, 2, {path("missing.safetensors")});
}

TEST_F(Usage, OutputsThatCannotBeWrittenAreCode3BeforeTheWork) {
  folder.write("file", "x");
  std::filesystem::create_directory(path("folder.exr"));
  for (const char* name : {"missing/a.png", "file/a.png", "folder.exr"}) {
    const Output output =
        run_gatelight({"render", scene(), "-o", path(name), "--spp", "16777216", "--verbose"});
    expect_failure(output, 3, {path(name)});
  }
  EXPECT_EQ(refused({"--stats", path("missing/s.json")}).exit_code, 3);
  EXPECT_EQ(refused({"--checkpoint", path("missing/c")}).exit_code, 3);
  EXPECT_EQ(refused({"--integrator", "nrc", "--cache-out", path("missing/c")}).exit_code, 3);
  EXPECT_EQ(read_file(path("file")), "x");
}

TEST_F(Usage, MemoryOverTheLimitIsCode4) {
  const Output output = refused({"--memory-limit", "1", "--size", "4096x4096"});
  expect_failure(output, 4, {"--memory-limit 1"});
}

TEST_F(Usage, AConfigFileSetsFlagsAndTheCommandLineWins) {
  const std::string config =
      folder.write("c.toml",
                   "# a comment\nspp = 2\nsize = \"16x8\"\neye = [0.5, 1, 3]\ntarget = \"0,0,0\"\n"
                   "output = [\"" +
                       path("one.exr") + "\", \"" + path("two.png") + "\"]\nquiet = true\n");
  const Output output =
      expect_done(run_gatelight({"render", scene(), "--config", config, "--spp", "1", "--stats", "-"}));
  EXPECT_EQ(output.err, "") << "quiet";
  EXPECT_THAT(output.out, HasSubstr("\"width\": 16"));
  EXPECT_THAT(output.out, HasSubstr("\"spp\": 1"));
  EXPECT_TRUE(std::filesystem::exists(path("one.exr")));
  EXPECT_TRUE(std::filesystem::exists(path("two.png")));
}

TEST_F(Usage, InfoChecksTheFlagsOfTheCache) {
  const Output alone = run_gatelight_inside({"info", "--integrator", "nrc"});
  expect_failure(alone, 1, {"--integrator", "SCENE"});
  const Output without = run_gatelight_inside({"info", scene(), "--batch", "8"});
  expect_failure(without, 1, {"--batch", "nao", "nrc"});
  EXPECT_EQ(without.out, "");
  expect_done(run_gatelight_inside({"info", scene(), "--camera", "front"}));
}

TEST_F(Usage, AConfigFileIsCheckedLikeTheCommandLine) {
  const Output unknown = refused({"--config", folder.write("u.toml", "sppp = 3\n")});
  expect_failure(unknown, 1, {path("u.toml"), "sppp"});
  const Output value = refused({"--config", folder.write("v.toml", "spp = -3\n")});
  expect_failure(value, 1, {"--spp", "-3", path("v.toml")});
  const Output missing = refused({"--config", path("missing.toml")});
  expect_failure(missing, 2, {"missing.toml"});
}

TEST_F(Usage, AConfigFileIsTextOfAtMostOneMebibyte) {
  const std::string zero = folder.write("zero.toml", std::string("spp = 2\0\n", 9));
  expect_failure(refused({"--config", "/dev/zero"}), 2, {"/dev/zero", "1 MiB"});
  expect_failure(refused({"--config", zero}), 2, {zero});
  // Some editors begin a text with a byte order mark.
  const Output marked = refused({"--config", folder.write("mark.toml", "\xEF\xBB\xBFspp = 0\n")});
  expect_failure(marked, 1, {path("mark.toml"), "spp"});
  const Output unknown = refused({"--config", folder.write("u.toml", std::string(100000, 'k') + " = 3\n")});
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_LT(unknown.err.size(), 1000u);
}

TEST_F(Usage, AnErrorInAValueOfAConfigFileNamesTheFile) {
  const std::string config = folder.write("c.toml", "eye = [1, 2]\nspp = 4\nbatch = 256\n");
  const auto expect_refused = [&](Words words, const char* flag, bool from_file) {
    words.insert(words.begin(), {"--config", config});
    const Output output = refused(words);
    expect_failure(output, 1, {flag});
    EXPECT_EQ(has_name(output.err, config), from_file) << output.err;
  };
  expect_refused({}, "--eye", true);
  expect_refused({"--eye", "1,2"}, "--eye", false);
  expect_refused({"--eye", "1,2,3", "--spp", "0"}, "--spp", false);
  // The settings conflict: --batch has no effect without a cache.
  expect_refused({"--eye", "1,2,3", "--target", "0,0,0"}, "--batch", true);
}

}  // namespace
}  // namespace gatelight::tests

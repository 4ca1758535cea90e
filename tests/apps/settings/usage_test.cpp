// The command line as a user meets it: help, refusals, exit codes and the last line on stderr.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class Usage : public ::testing::Test {
 protected:
  std::string scene() const { return folder.write("scene.gltf", tiny_scene()); }
  std::string path(const std::string& name) const { return (folder / name).string(); }

  /// Runs a render of the tiny scene that is to be refused. Within this process: there are many of them, and
  /// the program takes its time to start.
  Output refused(const std::vector<std::string>& flags) const {
    std::vector<std::string> arguments = {"render", scene(), "-o", path("a.png")};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    Output output = run_gatelight_inside(arguments);
    EXPECT_EQ(output.out, "");
    EXPECT_FALSE(std::filesystem::exists(path("a.png")));
    EXPECT_THAT(output.last_error_line(), StartsWith("gatelight: error: "));
    return output;
  }

  TemporaryFolder folder;
};

TEST_F(Usage, HelpGoesToStdoutAndNamesEveryFlagWithItsDefault) {
  const Output root = run_gatelight({"--help"});
  EXPECT_EQ(root.exit_code, 0);
  EXPECT_EQ(root.err, "");
  for (const char* word :
       {"render", "compare", "info", "merge", "sweep", "--config", "Exit codes", "Examples"}) {
    EXPECT_THAT(root.out, HasSubstr(word));
  }
  const Output render = run_gatelight({"render", "--help"});
  EXPECT_EQ(render.exit_code, 0);
  EXPECT_THAT(render.out, StartsWith("Render a scene"));
  for (const char* word : {"Usage: gatelight render",
                           "--integrator path|ao|nao|nrc",
                           "--spp N",
                           "[64]",
                           "--time-limit SECONDS",
                           "[960x540]",
                           "--region x0,y0,x1,y1",
                           "--max-depth",
                           "--min-depth",
                           "--seed",
                           "--threads",
                           "--camera NAME|INDEX",
                           "--eye",
                           "--target",
                           "--up",
                           "--fov DEGREES",
                           "--environment FILE|r,g,b|none",
                           "--environment-rotation DEGREES",
                           "--environment-scale",
                           "--exposure EV",
                           "--aov LIST",
                           "--clamp",
                           "--missing error|warn",
                           "--nan drop|error",
                           "--stats FILE|-",
                           "--progress auto|bar|json|none",
                           "--quiet",
                           "--verbose",
                           "--isa auto|scalar|avx2|avx512",
                           "--memory-limit MIB",
                           "--preset preview|final|paper-nao|paper-nrc",
                           "--train-steps N|auto",
                           "--stack LIST",
                           "[adaptive",
                           "--cache-memory MIB",
                           "--query-at primary|gather|spread|none",
                           "--checkpoint FILE",
                           "--tonemap none|filmic",
                           "--exr half|float",
                           "--ao-distance METRES",
                           "Examples:"}) {
    EXPECT_THAT(render.out, HasSubstr(word));
  }
  EXPECT_THAT(run_gatelight({"compare", "--help"}).out, HasSubstr("rel_mse"));
  EXPECT_THAT(run_gatelight({"info", "--help"}).out,
              AllOf(HasSubstr("Examples:"), HasSubstr("--integrator path|ao|nao|nrc"),
                    HasSubstr("--stack LIST"), HasSubstr("--environment FILE"), HasSubstr("[warn]")));
  EXPECT_THAT(run_gatelight_inside({"merge", "--help"}).out, HasSubstr("Example:"));
}

TEST_F(Usage, VersionIsOneLineOnStdout) {
  const Output output = run_gatelight({"--version"});
  EXPECT_EQ(output.exit_code, 0);
  EXPECT_THAT(output.out, ::testing::MatchesRegex("gatelight [0-9]+[.][0-9]+[.][0-9]+.*\n"));
  EXPECT_EQ(output.out.find('\n'), output.out.size() - 1);
}

TEST_F(Usage, AMissingOrUnknownSubcommandIsCode1) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{}, std::vector<std::string>{"frobnicate"},
        std::vector<std::string>{"--frob"}}) {
    const Output output = run_gatelight_inside(arguments);
    EXPECT_EQ(output.exit_code, 1);
    EXPECT_EQ(output.out, "");
    EXPECT_THAT(output.last_error_line(), HasSubstr("--help"));
  }
  EXPECT_THAT(run_gatelight({"frobnicate"}).last_error_line(), HasSubstr("'frobnicate'"));
}

TEST_F(Usage, UnknownFlagsAreRefusedByName) {
  for (const char* flag : {"--frob", "--check", "--ssp=4", "-z"}) {
    const Output output = refused({flag});
    EXPECT_EQ(output.exit_code, 1) << flag;
    EXPECT_THAT(output.last_error_line(), HasSubstr(flag));
  }
}

struct BadValue {
  std::vector<std::string> flags;
  std::string flag;
  std::string value;
  std::string expected;
};

TEST_F(Usage, BadValuesAreCode1AndNameFlagValueAndExpectation) {
  const std::vector<BadValue> cases = {
      {{"--spp", "0"}, "--spp", "'0'", "from 1 to"},
      {{"--spp", "4.5"}, "--spp", "'4.5'", "integer"},
      {{"--spp", "99999999999"}, "--spp", "'99999999999'", "from 1 to"},
      {{"--size", "0x10"}, "--size", "'0x10'", "from 1 to 65536"},
      {{"--size", "65536x65536"}, "--size", "'65536x65536'", "at most"},
      {{"--fov", "180"}, "--fov", "'180'", "at least 0.001 and at most 179.9"},
      {{"--fov", "0"}, "--fov", "'0'", "at least 0.001"},
      {{"--eye", "1e20,0,0", "--target", "0,0,0"}, "--eye", "1e+20", "at most 1e+12 m"},
      {{"--clamp", "1e-41"}, "--clamp", "'1e-41'", "0, or of at least 1.18e-38"},
      {{"--checkpoint", ""}, "--checkpoint", "''", "expected FILE"},
      {{"--stats", ""}, "--stats", "''", "expected FILE|-"},
      {{"--environment", ""}, "--environment", "''", "expected FILE|r,g,b|none"},
      {{"--camera", ""}, "--camera", "''", "expected NAME|INDEX"},
      {{"-o", ""}, "--output", "''", "expected FILE"},
      {{"--config", ""}, "--config", "''", "expected FILE.toml"},
      {{"--time-limit", "-1"}, "--time-limit", "'-1'", "at least 0"},
      {{"--time-limit", "nan"}, "--time-limit", "'nan'", "at least 0"},
      {{"--region", "0,0,961,1"}, "--region", "'0,0,961,1'", "x1 <= 960"},
      {{"--region", "5,5,5,6"}, "--region", "'5,5,5,6'", "x0 < x1"},
      {{"--seed", "4294967296"}, "--seed", "'4294967296'", "4294967295"},
      {{"--max-depth", "-1"}, "--max-depth", "'-1'", "from 0"},
      {{"--threads", "-2"}, "--threads", "'-2'", "from 0"},
      {{"--exposure", "inf"}, "--exposure", "'inf'", "at least -100 and at most 100"},
      {{"--clamp", "-0.5"}, "--clamp", "'-0.5'", "at least 0"},
      {{"--ao-distance", "0"}, "--ao-distance", "'0'", "above 0, or inf"},
      {{"--integrator", "nrc2"}, "--integrator", "'nrc2'", "path|ao"},
      {{"--isa", "sse9"}, "--isa", "'sse9'", "auto|scalar|avx2|avx512"},
      {{"--aov", "albedo,beauty"}, "--aov", "'beauty'", "albedo|normal"},
      {{"--environment", "1,-2,3"}, "--environment", "'1,-2,3'", "at least 0"},
      {{"--eye", "1,2", "--target", "0,0,0"}, "--eye", "'1,2'", "three numbers"},
      {{"--eye", "1,2,3"}, "--target", "--eye", "missing"},
      {{"--eye", "1,2,3", "--target", "1,2,3"}, "--target", "'1,2,3'", "another"},
      {{"--eye", "0,1,0", "--target", "0,5,0"}, "--up", "'0,1,0'", "parallel"},
      {{"--camera", "none such"}, "camera", "none such", "front"},
      {{"--progress", "loud"}, "--progress", "'loud'", "auto|bar|json|none"},
      {{"--quiet", "--verbose"}, "--quiet", "--verbose", "exclude"},
      {{"--train-steps", "-1"}, "--train-steps", "'-1'", "from 0"},
      {{"--train-steps", "many"}, "--train-steps", "'many'", "integer"},
      {{"--batch", "0"}, "--batch", "'0'", "from 1"},
      {{"--self-training", "on"}, "--self-training", "'on'", "integer"},
      {{"--self-training-full", "1.5"}, "--self-training-full", "'1.5'", "at most 1"},
      {{"--features", "17"}, "--features", "'17'", "from 1 to 16"},
      {{"--stack", "adaptive,65"}, "--stack", "'65'", "from 1 to 64"},
      {{"--stack", "1,2,3,4,5"}, "--stack", "'1,2,3,4,5'", "at most 4"},
      {{"--stack", "adaptive,"}, "--stack", "'adaptive,'", "list"},
      {{"--resolution", "fixed:0"}, "--resolution", "'0'", "from 1 to 64"},
      {{"--resolution", "fixed"}, "--resolution", "'fixed'", "uniform|paper|fixed:R"},
      {{"--node-spacing", "0"}, "--node-spacing", "'0'", "above 0"},
      {{"--cache-memory", "-1"}, "--cache-memory", "'-1'", "at least 0"},
      {{"--hash-log2-size", "32"}, "--hash-log2-size", "'32'", "from 3 to 31"},
      {{"--hash-growth", "0.5"}, "--hash-growth", "'0.5'", "at least 1"},
      {{"--hidden", "48"}, "--hidden", "'48'", "16|32|64|128"},
      {{"--layers", "6"}, "--layers", "'6'", "from 1 to 5"},
      {{"--bias", "yes"}, "--bias", "'yes'", "on|off"},
      {{"--learning-rate", "nan"}, "--learning-rate", "'nan'", "at least 0"},
      {{"--cache-roughness", "2"}, "--cache-roughness", "'2'", "at most 1"},
      {{"--device", "gpu"}, "--device", "'gpu'", "cpu|vulkan"},
      {{"--device", "vulkan:"}, "--device", "'vulkan:'", "vulkan:INDEX"},
      {{"--preset", "fast"}, "--preset", "'fast'", "preview|final|paper-nao|paper-nrc"},
      {{"--checkpoint-every", "-1"}, "--checkpoint-every", "'-1'", "at least 0"},
      {{"--query-at", "gather"}, "--query-at", "'path'", "nao or nrc"},
      {{"--aov", "resolution"}, "--aov", "'resolution'", "nao or nrc"},
      {{"--resume"}, "--resume", "", "--checkpoint FILE"},
      {{"--spp"}, "--spp", "", "required"},
      {{"--spp", "1", "--spp", "2"}, "--spp", "2", ""},
  };
  for (const BadValue& bad : cases) {
    const Output output = refused(bad.flags);
    EXPECT_EQ(output.exit_code, 1) << output.err;
    EXPECT_THAT(output.last_error_line(),
                AllOf(HasSubstr(bad.flag), HasSubstr(bad.value), HasSubstr(bad.expected)));
  }
}

TEST_F(Usage, AnOutputIsRequiredAndItsExtensionKnown) {
  EXPECT_EQ(run_gatelight({"render", scene()}).exit_code, 1);
  const Output output = run_gatelight({"render", scene(), "-o", path("a.jpg")});
  EXPECT_EQ(output.exit_code, 1);
  EXPECT_THAT(output.last_error_line(), AllOf(HasSubstr("a.jpg"), HasSubstr(".exr and .png")));
  EXPECT_EQ(refused({"-o", path("a.png")}).exit_code, 1);
}

TEST_F(Usage, UnusableInputsAreCode2AndNamed) {
  folder.write("empty.gltf", "");
  folder.write("text.glb", "this is no scene");
  folder.write("version.gltf", R"({"asset": {"version": "1.0"}})");
  for (const char* name : {"missing.gltf", "empty.gltf", "text.glb", "version.gltf", "."}) {
    const Output output = run_gatelight({"render", path(name), "-o", path("a.png")});
    EXPECT_EQ(output.exit_code, 2) << output.err;
    EXPECT_THAT(output.last_error_line(), HasSubstr(path(name)));
    EXPECT_EQ(run_gatelight({"info", path(name)}).exit_code, 2);
  }
  folder.write("broken.exr", "this is no picture");
  for (const char* name : {"missing.exr", "broken.exr", "missing.hdr"}) {
    const Output output = refused({"--environment", path(name)});
    EXPECT_EQ(output.exit_code, 2) << output.err;
    EXPECT_THAT(output.last_error_line(), HasSubstr(path(name)));
  }
  const Output cache = refused({"--integrator", "nrc", "--cache-in", path("missing.safetensors")});
  EXPECT_EQ(cache.exit_code, 2) << cache.err;
  EXPECT_THAT(cache.last_error_line(), HasSubstr(path("missing.safetensors")));
}

TEST_F(Usage, OutputsThatCannotBeWrittenAreCode3BeforeTheWork) {
  folder.write("file", "x");
  std::filesystem::create_directory(path("folder.exr"));
  for (const char* name : {"missing/a.png", "file/a.png", "folder.exr"}) {
    const Output output =
        run_gatelight({"render", scene(), "-o", path(name), "--spp", "16777216", "--verbose"});
    EXPECT_EQ(output.exit_code, 3) << output.err;
    EXPECT_THAT(output.last_error_line(), HasSubstr(path(name)));
  }
  EXPECT_EQ(refused({"--stats", path("missing/s.json")}).exit_code, 3);
  EXPECT_EQ(refused({"--checkpoint", path("missing/c")}).exit_code, 3);
  EXPECT_EQ(refused({"--integrator", "nrc", "--cache-out", path("missing/c")}).exit_code, 3);
  EXPECT_EQ(read_file(path("file")), "x");
}

TEST_F(Usage, MemoryOverTheLimitIsCode4) {
  const Output output = refused({"--memory-limit", "1", "--size", "4096x4096"});
  EXPECT_EQ(output.exit_code, 4) << output.err;
  EXPECT_THAT(output.last_error_line(), HasSubstr("more than --memory-limit 1; raise that limit"));
}

TEST_F(Usage, AConfigFileSetsFlagsAndTheCommandLineWins) {
  const std::string config =
      folder.write("c.toml",
                   "# a comment\nspp = 2\nsize = \"16x8\"\neye = [0.5, 1, 3]\ntarget = \"0,0,0\"\n"
                   "output = [\"" +
                       path("one.exr") + "\", \"" + path("two.png") + "\"]\nquiet = true\n");
  const Output output = run_gatelight({"render", scene(), "--config", config, "--spp", "1", "--stats", "-"});
  EXPECT_EQ(output.exit_code, 0) << output.err;
  EXPECT_EQ(output.err, "") << "quiet";
  EXPECT_THAT(output.out, HasSubstr("\"width\": 16"));
  EXPECT_THAT(output.out, HasSubstr("\"spp\": 1"));
  EXPECT_TRUE(std::filesystem::exists(path("one.exr")));
  EXPECT_TRUE(std::filesystem::exists(path("two.png")));
}

TEST_F(Usage, InfoChecksTheFlagsOfTheCache) {
  const Output alone = run_gatelight_inside({"info", "--integrator", "nrc"});
  EXPECT_EQ(alone.exit_code, 1);
  EXPECT_THAT(alone.last_error_line(), AllOf(HasSubstr("--integrator"), HasSubstr("SCENE")));
  const Output without = run_gatelight_inside({"info", scene(), "--batch", "8"});
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_EQ(without.out, "");
  EXPECT_THAT(without.last_error_line(), AllOf(HasSubstr("--batch"), HasSubstr("nao or nrc")));
  EXPECT_EQ(run_gatelight_inside({"info", scene(), "--camera", "front"}).exit_code, 0);
}

TEST_F(Usage, AConfigFileIsCheckedLikeTheCommandLine) {
  const Output unknown = refused({"--config", folder.write("u.toml", "sppp = 3\n")});
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.last_error_line(), AllOf(HasSubstr("u.toml'"), HasSubstr("sppp")));
  const Output value = refused({"--config", folder.write("v.toml", "spp = -3\n")});
  EXPECT_EQ(value.exit_code, 1);
  EXPECT_THAT(value.last_error_line(),
              AllOf(HasSubstr("--spp"), HasSubstr("'-3'"), HasSubstr("v.toml' sets --spp)")));
  const Output missing = refused({"--config", path("missing.toml")});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.last_error_line(), HasSubstr("missing.toml"));
}

TEST_F(Usage, AConfigFileIsAShortText) {
  const auto line = [&](const std::string& config) {
    const Output output = refused({"--config", config});
    EXPECT_EQ(output.exit_code, 2) << output.err;
    return output.last_error_line();
  };
  EXPECT_THAT(line("/dev/zero"), AllOf(HasSubstr("'/dev/zero'"), HasSubstr("more than 1 MiB")));
  EXPECT_THAT(line(folder.write("zero.toml", std::string("spp = 2\0\n", 9))),
              AllOf(HasSubstr("zero.toml'"), HasSubstr("a zero byte")));
  // Some editors begin a text with a mark of its byte order.
  const Output marked = refused({"--config", folder.write("mark.toml", "\xEF\xBB\xBFspp = 0\n")});
  EXPECT_THAT(marked.last_error_line(), HasSubstr("mark.toml' sets --spp)"));
  const Output unknown = refused({"--config", folder.write("u.toml", std::string(100000, 'k') + " = 3\n")});
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_LT(unknown.err.size(), 1000u);
}

TEST_F(Usage, AFlagGivenTwiceIsNamed) {
  const Output output = refused({"--spp", "2", "--spp", "3"});
  EXPECT_EQ(output.exit_code, 1);
  EXPECT_THAT(output.last_error_line(), HasSubstr("--spp is given 2 times, expected once"));
}

TEST_F(Usage, AValueOfAConfigFileIsSaidToStandThere) {
  const std::string config = folder.write("c.toml", "eye = [1, 2]\nspp = 4\nbatch = 256\n");
  const auto line = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"--config", config});
    const Output output = refused(words);
    EXPECT_EQ(output.exit_code, 1) << output.err;
    return output.last_error_line();
  };
  EXPECT_THAT(line({}), HasSubstr("c.toml' sets --eye)"));
  EXPECT_THAT(line({"--eye", "1,2"}), AllOf(HasSubstr("--eye"), Not(HasSubstr("sets"))))
      << "not from the file";
  EXPECT_THAT(line({"--eye", "1,2,3", "--spp", "0"}), AllOf(HasSubstr("--spp"), Not(HasSubstr("sets"))));
  EXPECT_THAT(line({"--eye", "1,2,3", "--target", "0,0,0"}), HasSubstr("c.toml' sets --batch)"))
      << "of what does not go together";
}

}  // namespace
}  // namespace gatelight::tests

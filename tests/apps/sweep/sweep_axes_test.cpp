// Lists of values, and the arguments of a sweep.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/sweep/flag_values.h"
#include "apps/sweep/request.h"
#include "apps/terminal/errors.h"
#include "tests/apps/sweep/sweep_records.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::apps {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Not;
using ::testing::Pair;
using tests::expect_parts;

template <typename Call>
ErrorParts refusal(Call call) {
  return tests::refused_parts<BadOption>(call);
}

TEST(SweepAxes, CommasSeparateValuesUnlessThereAreSemicolons) {
  EXPECT_THAT(split_values("features", "2,4,8"), ElementsAre("2", "4", "8"));
  EXPECT_THAT(split_values("stack", "adaptive,1;adaptive"), ElementsAre("adaptive,1", "adaptive"));
  EXPECT_THAT(split_values("stack", "adaptive,1", "--stack"), ElementsAre("adaptive,1"));
  EXPECT_THAT(split_values("stack", "adaptive;1", "--stack"), ElementsAre("adaptive", "1"));
  EXPECT_THAT(split_integers("spp", "16,1,4", {1, 100}), ElementsAre(1, 4, 16));
}

TEST(SweepAxes, VaryNamesAFlagWithOrWithoutDashes) {
  for (const char* text : {"batch=1,2", "--batch=1,2"}) {
    const SweepAxis axis = parse_vary(text);
    EXPECT_EQ(axis.flag, "--batch");
    EXPECT_THAT(axis.values, ElementsAre("1", "2"));
  }
  EXPECT_THAT(parse_vary("environment=1,1,1;none").values, ElementsAre("1,1,1", "none"));
  EXPECT_THAT(parse_vary("camera=a=b,c").values, ElementsAre("a=b", "c"));
  EXPECT_THAT(parse_vary("stack=adaptive,1").values, ElementsAre("adaptive,1"));
}

TEST(SweepAxes, BadListsAreRefusedWithFlagAndValue) {
  for (const char* text : {"2,,4", "", "2,", ","}) {
    expect_parts(refusal([&] { split_values("features", text); }), {"features", text, "", "values"});
  }
  expect_parts(refusal([] { split_values("features", "2,4,2"); }), {"features", "2,4,2", "'2' twice"});
  expect_parts(refusal([] { split_integers("spp", "1,x", {1, 9}); }), {"spp", "x", "", "1 to 9"});
  for (const char* text : {"batch", "=1", ""}) {
    expect_parts(refusal([&] { parse_vary(text); }), {"vary", text, "", "NAME=V1,V2"});
  }
}

ErrorParts refused(const SweepArguments& words) {
  return refusal([&] { make_request(words); });
}

TEST(SweepRuns, AreANameAndFlagsWithValues) {
  const NamedRun run = parse_run(" loss l2, fast :  --preset bare --loss=l2 --exposure -1");
  EXPECT_EQ(run.name, "loss l2, fast");
  EXPECT_THAT(run.flags,
              ElementsAre(Pair("--preset", "bare"), Pair("--loss", "l2"), Pair("--exposure", "-1")));
  EXPECT_TRUE(parse_run("default:").flags.empty());
  for (const char* text : {"bare", ": --spp 2", "a: spp 2", "a: --spp"})
    EXPECT_EQ(refusal([&] { parse_run(text); }).option, "run") << text;
}

TEST(SweepRuns, AreReadFromAFile) {
  const tests::TemporaryFolder folder;
  SweepArguments words = arguments({});
  words.plans = {folder.write("a.plan", "# one a line\n\none: --spp 1\r\n  two: --spp 2\n").string()};
  words.runs = {"three: --spp 3"};
  std::vector<std::string> names;
  for (const SweepBlock& block : make_request(words).blocks) names.push_back(block.row);
  EXPECT_THAT(names, ElementsAre("one", "two", "three"));
  for (const std::string& file : {folder.write("b.plan", "# nothing\n").string(), (folder / "none").string()})
    tests::expect_refusal<InputError>([&] { read_runs(file); }, {file});
}

TEST(SweepRuns, AreRefusedWithFlagsThatAreNotTheirs) {
  SweepArguments words = arguments({});
  const auto refused_run = [&](const std::string& run) {
    words.runs = {"one: --spp 1", run};
    return refused(words);
  };
  EXPECT_EQ(refused_run("two: --spp 2 --train-steps 8 --preset bare --hidden 64 --stack adaptive,1").option,
            "");
  for (const char* flag : {"--output", "--seed", "--stats", "--frob"})
    expect_parts(refused_run(std::string("two: ") + flag + " 2"), {"run", flag, "'two'"});
  words.train_steps = "8";
  EXPECT_EQ(refused_run("two:").option, "train-steps");
  SweepArguments finished = arguments({{"--integrator", "path"}});
  finished.preset = "finished";
  expect_parts(refused(finished), {"integrator", "path", "`preset`"});
}

TEST(SweepRequest, APresetOfRenderSetsIntegratorAndSamples) {
  SweepArguments words = arguments({});
  words.preset = "final";
  EXPECT_THAT(make_request(words).blocks[0].base, ElementsAre(Pair("--preset", "final")));
  EXPECT_THAT(make_request(arguments({}, {"preset=preview,final"})).blocks[0].base, ElementsAre());
}

TEST(SweepRequest, FlagsThatAreFixedAndVariedAreRefused) {
  SweepArguments both = arguments({{"--encoding", "gate"}});
  both.axes = {{kAxisFlags[1], "gate,hashgrid"}};
  expect_parts(refused(both), {"encoding", "gate", "`encodings`"});
  expect_parts(refused(arguments({{"--batch", "7"}}, {"batch=1,2"})), {"batch", "7", "`vary`"});
  expect_parts(refused(arguments({}, {"batch=1,2", "batch=3"})), {"vary", "--batch", "`vary`"});
  SweepArguments twice = arguments({}, {"features=2,4"});
  twice.axes = {{kAxisFlags[2], "8"}};
  expect_parts(refused(twice), {"vary", "--features", "`features`"});
  SweepArguments preset = arguments({}, {"preset=preview,final"});
  preset.preset = "preview";
  EXPECT_EQ(refused(preset).option, "preset");
}

TEST(SweepRequest, FlagsThatCannotBeVariedAreRefusedWithAnAlternative) {
  expect_parts(refused(arguments({}, {"seed=1,2"})), {"vary", "--seed", "", "--seeds"});
  expect_parts(refused(arguments({}, {"spp=1,2"})), {"vary", "--spp", "", "--cache-spp"});
  expect_parts(refused(arguments({}, {"train-steps=1,2"})),
               {"vary", "--train-steps", "", "--train-steps LIST"});
  for (const char* flag : {"output", "cache-in", "checkpoint", "time-limit", "train-time", "aov",
                           "cryptomatte", "variant", "frob"}) {
    expect_parts(refused(arguments({}, {std::string(flag) + "=a,b"})), {"vary", std::string("--") + flag});
  }
  EXPECT_EQ(refused(arguments({}, {"max-depth=1,2", "exposure=0,1", "view=final,cache"})).option, "");
}

TEST(SweepRequest, SeedsStartAtTheGivenSeed) {
  SweepArguments words = arguments({{"--seed", "40"}});
  words.seeds = "3";
  const SweepRequest request = make_request(words);
  EXPECT_EQ(request.first_seed, 40u);
  EXPECT_EQ(request.seeds, 3);
  EXPECT_THAT(request.blocks[0].base, Not(Contains(Pair("--seed", "40"))));
  words.seeds = "0";
  expect_parts(refused(words), {"seeds", "0"});
  words.seeds = "2";
  words.base = {{"--seed", "4294967295"}};
  expect_parts(refused(words), {"seed", "4294967295"});
  words.base = {{"--seed", "4000000007"}};
  expect_parts(refused(words), {"seed", "4000000007"});
}

TEST(SweepRequest, FlagsWinOverAPresetOfThePaper) {
  SweepArguments words = arguments({{"--size", "64x36"}, {"--batch", "512"}}, {"hidden=16,32"});
  words.preset = "paper-table1";
  words.train_steps = "4,2";
  const SweepRequest request = make_request(words);
  EXPECT_GE(request.blocks.size(), 6u);
  EXPECT_EQ(request.seeds, 3);
  EXPECT_FALSE(request.plain);
  for (const SweepBlock& block : request.blocks) {
    EXPECT_THAT(block.base, Contains(Pair("--size", "64x36")));
    EXPECT_THAT(block.base, Contains(Pair("--batch", "512")));
    EXPECT_EQ(block.axes.back().flag, "--hidden");
    EXPECT_THAT(block.train_steps, ElementsAre(2, 4));
  }
  words.preset = "paper-table3";
  expect_parts(refused(words), {"preset", "paper-table3", "", "preview", "paper-table1"});
}

TEST(SweepRequest, FlagsThatNameARowCannotBeChanged) {
  const auto refused_by = [](const std::string& preset, FlagValues base, std::vector<std::string> vary = {}) {
    SweepArguments words = arguments(std::move(base), std::move(vary));
    words.preset = preset;
    return refused(words);
  };
  expect_parts(refused_by("paper-table1", {{"--update", "sparse"}}), {"update", "sparse", "`preset`"});
  expect_parts(refused_by("paper-table1", {}, {"preset=preview,final"}), {"vary", "--preset"});
  EXPECT_EQ(refused_by("paper-adaptive", {{"--resolution", "uniform"}}).option, "resolution");
  EXPECT_EQ(refused_by("paper-table1", {{"--resolution", "uniform"}}).option, "")
      << "no row is named after it";
  EXPECT_EQ(refused_by("paper-table1", {{"--normal-input", "on"}}).option, "");
  SweepArguments axes = arguments({});
  axes.preset = "paper-table1";
  axes.axes = {{kAxisFlags[1], "gate,hashgrid"}};
  expect_parts(refused(axes), {"encodings", "--encoding"});
  axes.axes = {{kAxisFlags[0], "nrc"}};
  EXPECT_EQ(refused(axes).option, "integrators");
  axes.axes.clear();
  axes.scene_flags = {"room:update=sparse"};
  EXPECT_EQ(refused(axes).option, "for");
}

}  // namespace
}  // namespace gatelight::apps

// The pages of `gatelight manual`: their content, and the complaints of programs that read them.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include "apps/manual/roff.h"
#include "tests/apps/manual/help_flags.h"
#include "tests/apps/manual/shell_output.h"
#include "tests/support/folder_test.h"
#include "tests/support/process.h"

namespace gatelight::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class ManualPage : public FolderTest {
 protected:
  static std::string page(const std::string& name) {
    const Output output =
        name.empty() ? run_gatelight_inside({"manual"}) : run_gatelight_inside({"manual", name});
    EXPECT_EQ(output.exit_code, 0);
    EXPECT_EQ(output.err, "");
    return output.out;
  }
  /// As roff has it, with its dashes.
  static std::string dashes(const std::string& text) {
    return std::regex_replace(text, std::regex("-"), "\\-");
  }
};

TEST_F(ManualPage, HasEveryFlagOfTheHelp) {
  for (const std::string& name : subcommands()) {
    const std::string text = page(name);
    EXPECT_THAT(text, StartsWith(".TH GATELIGHT\\-"));
    for (const char* section :
         {"NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXIT STATUS", "ENVIRONMENT", "EXAMPLES", "SEE ALSO"})
      EXPECT_THAT(text, HasSubstr(fmt::format("\n.SH {}\n", section))) << name;
    EXPECT_THAT(text, HasSubstr("gatelight\\-" + name + " \\- "));
    for (const std::string& flag : flags_of(name))
      EXPECT_TRUE(
          std::regex_search(text, std::regex("\n(\\\\fB\\\\-[a-z]\\\\fR, )?\\\\fB" +
                                             std::regex_replace(flag, std::regex("-"), "\\\\-") + "\\\\fR")))
          << name << " " << flag;
    EXPECT_THAT(page(""), HasSubstr(".BR gatelight\\-" + name + " (1)\n"));
  }
}

TEST_F(ManualPage, NamesPlaceholdersDefaultsAndArguments) {
  const std::string text = page("render");
  EXPECT_THAT(text, HasSubstr("\\fBgatelight render\\fR \\fB\\-o\\fR \\fIFILE\\fR|\\- [\\fIOPTIONS\\fR] "
                              "\\fISCENE\\fR\n"));
  EXPECT_THAT(text, HasSubstr("\\fB\\-\\-spp\\fR \\fIN\\fR\nSamples per pixel; a limit with "
                              "\\fB\\-\\-time\\-limit\\fR or \\fB\\-\\-max\\-error\\fR.\nDefault: 64.\n"));
  EXPECT_THAT(text, HasSubstr("gatelight render room.glb \\-o room.exr"));
  EXPECT_THAT(page("merge"), HasSubstr("\\fIINPUT\\fR..."));
  EXPECT_THAT(page("info"), HasSubstr("[\\fISCENE\\fR]"));
  EXPECT_THAT(page("sweep"), Not(HasSubstr("\\fB\\-\\-tonemap\\fR \\fIVALUE\\fR")));
}

TEST_F(ManualPage, HasTheExitCodesOfTheProgram) {
  const std::string text = page("");
  for (const char* item : {"0\ndone", "1\nwrong usage", "9\nanother rank", "129, 130 and 143\nstopped by"})
    EXPECT_THAT(text, HasSubstr(fmt::format("\n.TP\n{}", item)));
}

TEST_F(ManualPage, NamesEachVariableThatTheSourcesRead) {
  std::set<std::string> variables;
  const std::regex variable("\"(GATELIGHT_[A-Z_]+)\"");
  for (const char* room : {"base", "scene", "neural", "renderer", "apps"}) {
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(std::string(GATELIGHT_SOURCE_DIR "/") + room)) {
      if (entry.path().extension() != ".cpp" || entry.path().filename() == "manual_page.cpp") continue;
      const std::string source = read_file(entry.path());
      for (std::sregex_iterator at(source.begin(), source.end(), variable), end; at != end; ++at)
        variables.insert((*at)[1]);
    }
  }
  variables.erase("GATELIGHT_VULKAN_LOSE_AFTER");  // makes a device fail, for tests
  EXPECT_GE(variables.size(), 4u);
  for (const std::string& name : variables) EXPECT_THAT(page("mpi"), HasSubstr("\n.TP\n" + name + "\n"));
}

TEST_F(ManualPage, AllAreWrittenIntoAFolder) {
  const std::string pages = path("share/man1");
  const Output output = run_gatelight_inside({"manual", "-o", pages});
  EXPECT_EQ(output.exit_code, 0);
  EXPECT_EQ(output.out + output.err, "");
  for (const std::string& name : subcommands())
    EXPECT_EQ(read_file(pages + "/gatelight-" + name + ".1"), page(name));
  EXPECT_EQ(read_file(pages + "/gatelight.1"), page(""));
  EXPECT_EQ(read_file(pages + "/gatelight-mpi.1"), page("mpi"));
}

TEST_F(ManualPage, WrongCallsAreRefused) {
  expect_failure(run_gatelight_inside({"manual", "rendr"}), 1, {"PAGE", "rendr", "render"});
  expect_failure(run_gatelight_inside({"manual", "render", "-o", path("a")}), 1, {"PAGE", "--output"});
  folder.write("file", "");
  expect_failure(run_gatelight_inside({"manual", "-o", path("file/man1")}), 3, {path("file/man1")});
  expect_failure(run_gatelight_inside({"completion", "tcsh"}), 1, {"SHELL", "tcsh", "bash", "zsh", "fish"});
}

TEST_F(ManualPage, ReadersOfManualPagesHaveNoComplaint) {
  ASSERT_EQ(run_gatelight_inside({"manual", "-o", path("man1")}).exit_code, 0);
  int readers = 0;
  for (const std::string reader :
       {"groff -man -Tutf8 -ww", "man --warnings -l", "mandoc -T lint -W warning"}) {
    if (!has_program(reader.substr(0, reader.find(' ')))) continue;
    ++readers;
    for (const auto& entry : std::filesystem::directory_iterator(path("man1"))) {
      const std::string only_errors = reader.starts_with("mandoc") ? "" : " > /dev/null";
      std::string said =
          shell_output("LC_ALL=C.UTF-8 " + reader + " '" + entry.path().string() + "' 2>&1" + only_errors);
      said = std::regex_replace(said, std::regex("mandoc: [^\n]*missing date[^\n]*\n"), "");
      EXPECT_EQ(said, "") << reader;
    }
  }
  if (readers == 0) GTEST_SKIP() << "neither groff nor man nor mandoc is here";
}

TEST(Roff, TextHasNoMeaningForRoff) {
  EXPECT_EQ(apps::roff_prose(".glb or 'a\\b'"), "\\&.glb or \\(aqa\\eb\\(aq\n");
  EXPECT_EQ(apps::roff_prose("64-bit; `x y` --aov a-b -o"),
            "64\\-bit; \\fBx y\\fR \\fB\\-\\-aov\\fR a\\-b \\fB\\-o\\fR\n");
  EXPECT_EQ(apps::roff_code("  a 'b'\n.c\n"), ".EX\na \\(aqb\\(aq\n\\&.c\n.EE\n");
}

TEST(Roff, IndentedLinesAreItems) {
  EXPECT_EQ(apps::roff_paragraphs("One\ntwo:\n  a-b   text\n      more\nThree.\n\nFour.\n"),
            "One\ntwo:\n.TP\n\\fBa\\-b\\fR\ntext\nmore\n.PP\nThree.\n.PP\nFour.\n");
}

}  // namespace
}  // namespace gatelight::tests

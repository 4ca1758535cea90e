// The scripts of `gatelight completion` in the shells that are installed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/manual/shell_output.h"
#include "tests/support/folder_test.h"
#include "tests/support/process.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

class Shells : public FolderTest {
 protected:
  void SetUp() override {
    folder.write("a room.gltf", tiny_scene());
    folder.write("tree.glb", tiny_scene());
    folder.write("notes.txt", "");
    folder.write("sub/deep.glb", "");
  }

  /// Writes the script of the shell, and returns its file.
  std::string script(const std::string& shell) const {
    const Output output = run_gatelight_inside({"completion", shell});
    EXPECT_EQ(output.exit_code, 0);
    return folder.write("script." + shell, output.out);
  }

  std::vector<std::string> lines_of(const std::string& command) const {
    std::vector<std::string> lines;
    std::istringstream text(shell_output("cd '" + path("") + "' && HOME=$PWD " + command));
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  }

  /// The answers of bash where the last word is being typed. `words`: as bash parts the line, quoted for it.
  std::vector<std::string> in_bash(const std::string& line, const std::string& words) const {
    const std::string file = script("bash");
    folder.write("try", "source '" + file + "'\nCOMP_WORDS=('" GATELIGHT_PROGRAM "' " + words +
                            ")\nCOMP_LINE=\"" GATELIGHT_PROGRAM " \"" + line +
                            "\nCOMP_POINT=${#COMP_LINE} COMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n"
                            "_gatelight\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
    return lines_of("bash try 2>&1");
  }

  std::vector<std::string> in_fish(const std::string& line) const {
    folder.write("try", "source '" + script("fish") + "'\nset -x PATH '" +
                            std::filesystem::path(GATELIGHT_PROGRAM).parent_path().string() +
                            "' $PATH\ncomplete -C '" + line + "'\n");
    std::vector<std::string> words = lines_of("fish --no-config try 2>&1");
    for (std::string& word : words) word = word.substr(0, word.find('\t'));
    return words;
  }
};

TEST_F(Shells, BashCompletesSubcommandsFlagsAndValues) {
  if (!has_program("bash")) GTEST_SKIP() << "bash is not here";
  EXPECT_THAT(in_bash("'re'", "re"), ElementsAre("render"));
  EXPECT_THAT(in_bash("'render --tone'", "render --tone"), ElementsAre("--tonemap"));
  EXPECT_THAT(in_bash("'render --integrator na'", "render --integrator na"), ElementsAre("nao"));
  EXPECT_THAT(in_bash("'render --integrator=na'", "render --integrator = na"), ElementsAre("nao"));
  EXPECT_THAT(in_bash("'render --integrator='", "render --integrator ="), Contains("path"));
  EXPECT_THAT(in_bash("'render --aov albedo,no'", "render --aov albedo,no"), ElementsAre("albedo,normal"));
  EXPECT_THAT(in_bash("'sweep --vary integrator=p'", "sweep --vary integrator = p"), ElementsAre("path"));
}

TEST_F(Shells, BashNeedsNoLineBesideTheWords) {
  if (!has_program("bash")) GTEST_SKIP() << "bash is not here";
  folder.write("try", "source '" + script("bash") +
                          "'\nCOMP_WORDS=('" GATELIGHT_PROGRAM
                          "-mpi' render --preset '') COMP_CWORD=3\n_gatelight\necho \"${COMPREPLY[@]}\"\n");
  EXPECT_THAT(lines_of("bash try 2>&1"), ElementsAre("bare preview standard final paper-nao paper-nrc"));
}

TEST_F(Shells, BashCompletesFiles) {
  if (!has_program("bash")) GTEST_SKIP() << "bash is not here";
  EXPECT_THAT(in_bash("'render '", "render ''"), UnorderedElementsAre("a room.gltf", "tree.glb", "sub"));
  EXPECT_THAT(in_bash("'render sub/'", "render sub/"), ElementsAre("sub/deep.glb"));
  EXPECT_THAT(in_bash("'render ~/t'", "render '~/t'"), ElementsAre("~/tree.glb"));
  EXPECT_THAT(in_bash("'render $HOME/t'", "render '$HOME/t'"), ElementsAre(path("tree.glb")));
  EXPECT_THAT(in_bash("'render --stats '", "render --stats ''"), Contains("notes.txt"));
  EXPECT_THAT(in_bash("'render --stats=no'", "render --stats = no"), ElementsAre("notes.txt"));
  EXPECT_THAT(in_bash("'render --ies lamp=no'", "render --ies lamp = no"), ElementsAre("notes.txt"));
  EXPECT_THAT(in_bash("'sweep -o '", "sweep -o ''"), ElementsAre("sub"));
}

TEST_F(Shells, BashCompletesCameras) {
  if (!has_program("bash")) GTEST_SKIP() << "bash is not here";
  EXPECT_THAT(in_bash("'render tree.glb --camera '", "render tree.glb --camera ''"),
              ElementsAre("all", "front"));
  EXPECT_THAT(in_bash("'render a\\ room.gltf --camera=f'", "render 'a\\ room.gltf' --camera = f"),
              ElementsAre("front"));
  EXPECT_THAT(in_bash("'render ~/tree.glb --camera f'", "render '~/tree.glb' --camera f"),
              ElementsAre("front"));
}

TEST_F(Shells, BashQuotesNamesThatNeedIt) {
  if (!has_program("bash")) GTEST_SKIP() << "bash is not here";
  std::string scene = tiny_scene();
  scene.replace(scene.find("\"name\": \"front\", \"type\""), 15, "\"name\": \"Cam $1\"");
  folder.write("quoted.gltf", scene);
  EXPECT_THAT(in_bash("'render quoted.gltf --camera C'", "render quoted.gltf --camera C"),
              ElementsAre("Cam\\ \\$1"));
}

TEST_F(Shells, FishCompletesTheSame) {
  const std::string file = script("fish");
  if (!has_program("fish")) GTEST_SKIP() << "fish is not here";
  EXPECT_THAT(lines_of("fish -n '" + file + "' 2>&1"), ElementsAre());
  EXPECT_THAT(in_fish("gatelight re"), ElementsAre("render"));
  EXPECT_THAT(in_fish("gatelight render --tone"), ElementsAre("--tonemap"));
  EXPECT_THAT(in_fish("gatelight render --integrator=na"), ElementsAre("--integrator=nao"));
  EXPECT_THAT(in_fish("gatelight render "), UnorderedElementsAre("a room.gltf", "tree.glb", "sub/"));
  EXPECT_THAT(in_fish("gatelight render ~/t"), ElementsAre("~/tree.glb"));
  EXPECT_THAT(in_fish("gatelight render --stats=no"), ElementsAre("--stats=notes.txt"));
  EXPECT_THAT(in_fish("gatelight render a\\\\ room.gltf --camera "), UnorderedElementsAre("all", "front"));
  EXPECT_THAT(in_fish("gatelight-mpi render --integrator na"), ElementsAre("nao"));
}

TEST_F(Shells, ZshReadsItsScript) {
  const std::string file = script("zsh");
  EXPECT_THAT(read_file(file), ::testing::StartsWith("#compdef gatelight gatelight-mpi\n"));
  if (!has_program("zsh")) GTEST_SKIP() << "zsh is not here";
  EXPECT_THAT(lines_of("zsh -n '" + file + "' 2>&1"), ElementsAre());
}

}  // namespace
}  // namespace gatelight::tests

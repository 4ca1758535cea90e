// The Tab key: words of the program, in bash too.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/folder_test.h"
#include "tests/support/process.h"

namespace gatelight::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string words_for(std::vector<std::string> line) {
  line.insert(line.begin(), "__complete");
  return run_gatelight_inside(line).out;
}

TEST(Completion, NamesSubcommandsFlagsAndValues) {
  EXPECT_THAT(words_for({"re"}), StartsWith("render\ncompare\ninfo\n"));
  EXPECT_THAT(words_for({"render", "a.glb", "--"}),
              AllOf(HasSubstr("\n--tonemap\n"), HasSubstr("--config\n")));
  EXPECT_THAT(words_for({"merge", "-"}), AllOf(HasSubstr("\n--output\n"), Not(HasSubstr("--tonemap"))));
  EXPECT_EQ(words_for({"render", "a.glb", "--denoiser", ""}), "auto\noidn\nnone\n");
  EXPECT_EQ(words_for({"render", "--device", "v"}), "auto\ncpu\nvulkan\n");
  EXPECT_EQ(words_for({"render", "--stats", ""}), "\n") << "a file";
  EXPECT_EQ(words_for({"render", "a"}), "\n") << "a file";
}

class Shells : public FolderTest {};

TEST_F(Shells, BashAsksTheProgram) {
  if (std::system("command -v bash > /dev/null") != 0) GTEST_SKIP() << "bash is not here";
  const std::string script = folder.write("script", run_gatelight_inside({"completion", "bash"}).out);
  const std::string file = folder.write("try", "source '" + script +
                                                   "'\n"
                                                   R"(
COMP_WORDS=(gatelight render --tonemap f) COMP_CWORD=3
_gatelight "$1-mpi" f --tonemap
[[ ${COMPREPLY[*]} == filmic ]]
)");
  EXPECT_EQ(std::system(("bash '" + file + "' " GATELIGHT_PROGRAM).c_str()), 0);
}

}  // namespace
}  // namespace gatelight::tests

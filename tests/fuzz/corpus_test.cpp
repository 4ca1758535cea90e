// Every file that fuzzing has left behind goes through its target: without libFuzzer, in each test run.

#include <gtest/gtest.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/fuzz/targets.h"

namespace gatelight::fuzz {
namespace {

std::vector<std::filesystem::path> files_of(const std::string& target) {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path fuzz = std::filesystem::path(GATELIGHT_SOURCE_DIR) / "tests/fuzz";
  for (const char* kind : {"corpus", "crashes"}) {
    const std::filesystem::path folder = fuzz / kind / target;
    if (!std::filesystem::exists(folder)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Empty, or the exception of the target.
std::string outcome(const Target& target, const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  std::string thrown;
  // A program that refuses prints the reason.
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  try {
    target.run({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  } catch (const std::exception& error) {
    thrown = error.what();
  }
  ::testing::internal::GetCapturedStdout();
  const std::string said = ::testing::internal::GetCapturedStderr();
  return thrown.empty() ? "" : thrown + "; " + said;
}

class Corpus : public ::testing::TestWithParam<Target> {};

TEST_P(Corpus, IsReadOrRefused) {
  const std::vector<std::filesystem::path> files = files_of(GetParam().name);
  EXPECT_FALSE(files.empty());
  for (const std::filesystem::path& file : files) {
    EXPECT_EQ(outcome(GetParam(), file), "") << file;
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, Corpus, ::testing::ValuesIn(kTargets),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace gatelight::fuzz

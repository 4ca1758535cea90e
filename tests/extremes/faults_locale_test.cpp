// A locale with a comma in its numbers.

#include <clocale>
#include <cstdlib>
#include <locale>
#include <nlohmann/json.hpp>

#include "tests/extremes/faults.h"

namespace gatelight::tests {
namespace {

using ::testing::HasSubstr;

class DecimalComma : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

class CommaLocale : public Faults {
 protected:
  /// Sets a decimal comma in C, by a locale that is made here, and in C++.
  bool begin() {
    folder.write("source",
                 "LC_NUMERIC\ndecimal_point \"<U002C>\"\nthousands_sep \"<U002E>\"\ngrouping 3;3\n"
                 "END LC_NUMERIC\n");
    const std::string make =
        "localedef -c -i '" + path("source") + "' -f ANSI_X3.4-1968 '" + path("comma") + "' >/dev/null 2>&1";
    // localedef warns of the categories that are left out.
    static_cast<void>(std::system(make.c_str()));
    ::setenv("LOCPATH", folder.path().c_str(), 1);
    before_ = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
    return std::setlocale(LC_ALL, "comma") != nullptr && std::string(std::localeconv()->decimal_point) == ",";
  }
  void end() {
    std::locale::global(before_);
    std::setlocale(LC_ALL, "C");
    ::unsetenv("LOCPATH");
  }
  void TearDown() override { end(); }

  std::locale before_ = std::locale::classic();
};

/// The file without the values that may differ between two runs.
nlohmann::json without_times(const std::string& file) {
  nlohmann::json json = nlohmann::json::parse(read_file(file));
  for (const char* key : {"seconds", "memory_bytes", "train"}) json.erase(key);
  return json;
}

TEST_F(CommaLocale, ChangesNoNumberInAnyFile) {
  folder.write("flags.toml",
               "fov = 47.5\neye = [0.25, 0.5, 2.75]\ntarget = [0, 0, 0.125]\nclamp = 1.5e1\n"
               "environment-scale = 1.25\nspp = 4\n");
  // Both under the same names: some are part of the recipe.
  const std::string name = "a";
  const auto run = [&] {
    expect_done(run_gatelight_inside(
        square("--config {} --quiet --reproducible --size 32x32 --learning-rate 0.0078125 --integrator nrc "
               "--train-steps 8 --batch 512 -o {} -o {} --stats {} --cache-out {}",
               {path("flags.toml"), path(name + ".exr"), path(name + ".png"), path(name + ".json"),
                path(name + ".safetensors")})));
    const Output compared = run_gatelight_inside(
        {"compare", path(name + ".exr"), path(name + ".png"), "--json", path(name + ".compare.json")});
    const Output reported = run_gatelight_inside({"info", scene, "--json", path(name + ".info.json")});
    EXPECT_EQ(compared.exit_code + reported.exit_code, 0) << compared.err << reported.err;
    std::vector<std::string> bytes;
    for (const char* kind : {".exr", ".png", ".safetensors", ".compare.json"})
      bytes.push_back(read_file(path(name + kind)));
    return bytes;
  };
  const std::vector<std::string> with_points = run();
  const nlohmann::json statistics = without_times(path("a.json"));
  if (!begin()) GTEST_SKIP() << "no locale with a comma can be made here (localedef)";
  char text[16];
  std::snprintf(text, sizeof text, "%.1f", 1.5);
  ASSERT_STREQ(text, "1,5");
  const std::vector<std::string> with_commas = run();
  end();
  for (std::size_t i = 0; i < with_points.size(); ++i) {
    EXPECT_GT(with_points[i].size(), 100u) << i;
    EXPECT_EQ(with_points[i] == with_commas[i], true) << i;
  }
  EXPECT_EQ(statistics, without_times(path("a.json")));
  EXPECT_THAT(read_file(path("a.json")), HasSubstr("47.5"));
}

TEST_F(CommaLocale, TheLocaleOfTheEnvironmentIsIgnored) {
  const Words all = square("-o {} --size 16x16 --spp 2 --clamp 1.5 --quiet --stats -", {path("a.exr")});
  if (!begin()) GTEST_SKIP() << "no locale with a comma can be made here (localedef)";
  const Output output = run_gatelight(all, [] { ::setenv("LC_ALL", "comma", 1); });
  end();
  EXPECT_EQ(output.exit_code, 0) << output.err;
  EXPECT_EQ(nlohmann::json::parse(output.out)["options"]["clamp"], 1.5);
  const Output comma = run_gatelight(square("-o {} --clamp 1,5 --quiet", {path("a.exr")}));
  expect_failure(comma, 1, {"--clamp", "1,5", "0"});
}

}  // namespace
}  // namespace gatelight::tests

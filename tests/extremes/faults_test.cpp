// Errors of disks and pipes, libraries that are missing, renders that are stopped and resumed, and a locale
// with a comma in its numbers.

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <linux/capability.h>

#include <clocale>
#include <cstdlib>
#include <locale>
#include <nlohmann/json.hpp>

#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "tests/extremes/faults.h"

namespace gatelight::tests {
namespace {

using FaultyDisk = Faults;
using ::testing::HasSubstr;

const Words kKinds = {"a.exr", "a.png", "stats.json", "checkpoint", "cache"};

/// Arguments of a render whose output of one kind is at `place`, with a picture at `other`.
Words outputs(const std::string& kind, const std::string& place, const std::string& other) {
  if (kind == "a.exr" || kind == "a.png") return {"-o", place, "-o", other};
  if (kind == "stats.json") return {"-o", other, "--stats", place};
  if (kind == "checkpoint") return {"-o", other, "--checkpoint", place, "--checkpoint-every", "0"};
  return words_of("-o {} --integrator nrc --train-steps 8 --batch 512 --cache-out {}", {other, place});
}

/// Root writes everywhere by a capability, which a program loses that is run without it.
void drop_capability() {
  ::prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE, 0, 0, 0);
}

/// The writing end of a pipe without a reader.
int broken_pipe() {
  int ends[2];
  if (::pipe(ends) != 0) ::_exit(126);
  ::close(ends[0]);
  return ends[1];
}

/// A limit of the size of files acts like a full disk.
TEST_F(FaultyDisk, AFullDiskKeepsTheOldFileAndLeavesNoTemporaryFile) {
  for (const std::string& kind : kKinds) {
    folder.write("disk/" + kind, "old");
    // Statistics and the picture beside a checkpoint are smaller than both limits.
    const rlim_t bytes = kind == "checkpoint" || kind == "cache" ? 40000 : 1000;
    const Words words = outputs(kind, path("disk/" + kind), path("other.exr"));
    const Output output = run_gatelight(square("--size 64x64 --spp 2 --quiet", {}, words), [&] {
      const rlimit limit{bytes, bytes};
      ::setrlimit(RLIMIT_FSIZE, &limit);
    });
    EXPECT_EQ(output.exit_code, 3) << kind << output.err;
    EXPECT_FALSE(output.killed) << kind;
    // Statistics fit, the picture beside them does not.
    expect_message(output.last_error_line(), {path(kind == "stats.json" ? "other.exr" : "disk/" + kind)});
    EXPECT_EQ(read_file(path("disk/" + kind)), "old") << kind;
    if (bytes > 1000) {
      EXPECT_EQ(renderer::read_image(path("other.exr")).width, 64) << kind;
    }
    std::filesystem::remove(path("other.exr"));
  }
  EXPECT_EQ(folder.count_files(), 2u) << "a temporary file is left";
  const auto left = std::distance(std::filesystem::directory_iterator(folder / "disk"), {});
  EXPECT_EQ(static_cast<std::size_t>(left), kKinds.size()) << "a temporary file is left beside the old ones";
}

TEST_F(FaultyDisk, AReadOnlyFolderOrFileIsRefusedBeforeTheWork) {
  const std::filesystem::path locked = folder / "locked";
  std::filesystem::create_directory(locked);
  std::filesystem::permissions(locked, std::filesystem::perms(0555));
  for (const std::string& kind : kKinds) {
    const auto refused = [&](const std::string& place) {
      return run_gatelight(
          square("--size 4096x4096 --spp 65536 --quiet", {}, outputs(kind, place, path("other.exr"))),
          drop_capability);
    };
    expect_failure(refused((locked / kind).string()), 3, {locked.string()});
    const std::string kept = folder.write(kind, "a reference of last year");
    std::filesystem::permissions(kept, std::filesystem::perms(0444));
    expect_failure(refused(kept), 3, {kept});
    EXPECT_EQ(read_file(kept), "a reference of last year");
  }
  std::filesystem::permissions(locked, std::filesystem::perms(0755));
  expect_failure(run_gatelight(square("-o {} --quiet", {scene + "/a.exr"})), 3, {scene});
}

TEST_F(FaultyDisk, ARemovedFolderLosesOnlyItsOwnOutputs) {
  std::filesystem::create_directory(folder / "gone");
  Process process(
      square("-o {} -o {} --checkpoint {} --checkpoint-every 0 --size 64x64 --spp 16777216 "
             "--progress json",
             {path("gone/a.exr"), path("stays.exr"), path("gone/c")}));
  ASSERT_TRUE(process.wait_for_error_text("\"progress\""));
  std::filesystem::remove_all(folder / "gone");
  ASSERT_TRUE(process.wait_for_error_text("the write will be retried"));
  process.send(SIGTERM);
  const Output output = process.finish();
  EXPECT_EQ(output.exit_code, 3) << output.err;
  expect_message(output.last_error_line(), {path("gone")});
  EXPECT_EQ(renderer::read_image(path("stays.exr")).width, 64);
  EXPECT_EQ(folder.count_files(), 2u);
}

TEST_F(FaultyDisk, AnUnwritableStderrIsIgnoredAndAnUnwritableStdoutIsCode3) {
  const auto full = [] { return ::open("/dev/full", O_WRONLY); };
  for (const std::function<int()>& open : {std::function<int()>(full), std::function<int()>(broken_pipe)}) {
    std::filesystem::remove(path("a.exr"));
    expect_done(run_gatelight(square("-o {} --size 16x16 --spp 2 --progress json --verbose", {path("a.exr")}),
                              [&] { ::dup2(open(), STDERR_FILENO); }));
    EXPECT_EQ(renderer::read_image(path("a.exr")).width, 16);
    expect_failure(run_gatelight(square("-o {} --size 16x16 --spp 2 --quiet --stats -", {path("a.exr")}),
                                 [&] { ::dup2(open(), STDOUT_FILENO); }),
                   3, {"stdout"});
  }
}

class Libraries : public Faults {
 protected:
  /// Runs a copy of the program without the files beside it.
  Output run_alone(Words arguments) const {
    const std::string copy = path("bin/gatelight");
    std::filesystem::create_directory(folder / "bin");
    std::filesystem::copy_file(GATELIGHT_PROGRAM, copy, std::filesystem::copy_options::overwrite_existing);
    arguments.insert(arguments.begin(), copy);
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    return run_gatelight({}, [&] { ::execv(copy.c_str(), words.data()); });
  }
};

TEST_F(Libraries, MissingLibrariesAreReportedBeforeWorkThatRequiresThem) {
  const std::string hdr = folder.write("sky.hdr", "not even a picture");
  const std::string sky_png = path("sky.png");  // must be scaled
  renderer::Picture pixel{
      .width = 1, .height = 1, .layers = {{.channels = {"R", "G", "B"}, .values = {0, 0, 0}}}};
  renderer::write_image(pixel, sky_png);
  for (const Words& arguments :
       {std::vector<std::string>{"render", scene, "--environment", hdr, "-o", path("a.exr")},
        {"render", scene, "-o", path("a.tif")},
        {"render", scene, "-o", "hdr:-"},
        {"render", scene, "--background", sky_png, "-o", path("a.exr")},
        {"compare", hdr, hdr}}) {
    expect_failure(run_alone(arguments), 5,
                   {"cannot load OpenImageIO", "gatelight_openimageio.so", "gatelight-openimageio"});
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
  // Renders that do not need the library work.
  const std::string picture = path("a.png");
  expect_done(run_alone(square("-o {} --spp 1 --size 16x16 --quiet", {picture})));
  EXPECT_TRUE(std::filesystem::exists(picture));
}

class Stopped : public Faults {
 protected:
  Words learning(const std::string& output, const Words& more) const {
    return square(
        "-o {} --size 48x48 --spp 4 --integrator nrc --train-steps 3000 --batch 1024 --progress json "
        "--reproducible",
        {path(output)}, more);
  }
};

TEST_F(Stopped, TerminationDuringTrainingKeepsPictureAndCheckpoint) {
  const Words keeps = words_of("--checkpoint {} --resume --cache-out {}", {path("c"), path("c.safetensors")});
  Process process(learning("killed.exr", keeps));
  ASSERT_TRUE(process.wait_for_error_text("\"train\""));
  process.send(SIGTERM);
  const Output output = process.finish();
  EXPECT_EQ(output.exit_code, 143) << output.err;
  EXPECT_FALSE(output.killed);
  expect_message(output.last_error_line(), {"3000", "killed.exr", "--resume", path("c.safetensors")});
  EXPECT_EQ(renderer::read_image(path("killed.exr")).width, 48);
  EXPECT_EQ(folder.count_files(), 3u) << "a temporary file is left, or part of a cache";
  expect_done(run_gatelight(learning("killed.exr", keeps)));
  expect_done(run_gatelight(learning("straight.exr", {})));
  EXPECT_TRUE(read_file(path("killed.exr")) == read_file(path("straight.exr")));
}

TEST_F(Stopped, ResumingWithAnotherSceneIsRefused) {
  const std::string now = tiny_scene();
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = now;
    text.replace(text.find(from), from.size(), to);
    folder.write("scene.gltf", text);
    return run_gatelight(
        square("-o {} --size 16x16 --spp 2 --quiet --checkpoint {} --resume", {path("a.exr"), path("c")}));
  };
  expect_done(changed("\"asset\"", "\"asset\""));
  const std::string kept = read_file(path("c"));
  expect_failure(changed("AACAvwAAgL8", "AACAPwAAgL8"), 2, {"geometry"});
  expect_failure(changed("\"metallicFactor\": 0", "\"metallicFactor\": 1"), 2, {"materials"});
  expect_failure(changed("\"yfov\": 0.9", "\"yfov\": 0.8"), 2, {"camera"});
  EXPECT_TRUE(read_file(path("c")) == kept);
  expect_done(changed("\"asset\"", "\"asset\""));
}

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

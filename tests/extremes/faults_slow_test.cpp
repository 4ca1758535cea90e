// Limits of memory, threads and sizes; names of files.

#include <fmt/format.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "renderer/image/image_read.h"
#include "tests/extremes/faults.h"

namespace gatelight::tests {
namespace {

using ::testing::AnyOf;
namespace fs = std::filesystem;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

using Limits = Faults;

Output run_within(rlim_t mebibytes, const Words& words) {
  return run_gatelight(words, [=] {
    const rlimit limit{mebibytes << 20, mebibytes << 20};
    ::setrlimit(RLIMIT_AS, &limit);
  });
}

constexpr rlim_t kMinMebibytes = 384;

TEST_F(Limits, AddressSpaceLimitsEndInAPictureOrInOneErrorLine) {
  if (kSanitized) GTEST_SKIP() << "sanitizers take terabytes of addresses";
  int pictures = 0;
  int refusals = 0;
  for (rlim_t mebibytes = kMinMebibytes; mebibytes <= 2560; mebibytes += 512) {
    for (const char* picture : {"--integrator path --size 4096x2048 --max-depth 1",
                                "--integrator nrc --size 64x64 --train-steps 8"}) {
      const Output output =
          run_within(mebibytes, square("-o {} --spp 1 --quiet", {path("a.exr")}, words_of(picture)));
      ASSERT_THAT(output.exit_code, AnyOf(0, 4)) << mebibytes << " MiB " << picture << ": " << output.err;
      ASSERT_FALSE(output.killed);
      if (output.exit_code == 0) {
        ++pictures;
      } else {
        ++refusals;
        expect_failure(output, 4, {"MiB"});
        EXPECT_EQ(fs::exists(path("a.exr")), false);
      }
      fs::remove(path("a.exr"));
    }
  }
  EXPECT_GT(pictures, 2);
  EXPECT_GT(refusals, 0);
}

/// A new control group below that of this process, where that is permitted.
class MemoryGroup {
 public:
  explicit MemoryGroup(std::size_t bytes) {
    std::ifstream groups("/proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {
      const std::string name = "/gatelight-test-" + std::to_string(::getpid());
      if (line.find(":memory:") != std::string::npos) {
        try_at("/sys/fs/cgroup/memory" + line.substr(line.rfind(':') + 1) + name, "memory.limit_in_bytes",
               bytes);
      } else if (line.starts_with("0::")) {
        try_at("/sys/fs/cgroup" + line.substr(3) + name, "memory.max", bytes);
      }
    }
  }
  ~MemoryGroup() {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove(folder_, ignored);
  }
  MemoryGroup(const MemoryGroup&) = delete;
  MemoryGroup& operator=(const MemoryGroup&) = delete;

  bool is_there() const { return !folder_.empty(); }
  /// Moves the calling process into the group.
  void enter() const { std::ofstream(folder_ + "/cgroup.procs") << ::getpid(); }

 private:
  void try_at(const std::string& folder, const char* limit, std::size_t bytes) {
    std::error_code error;
    if (!folder_.empty() || !fs::create_directory(folder, error)) return;
    std::ofstream(folder + "/" + limit) << bytes << std::flush;
    std::size_t set = 0;
    std::ifstream(folder + "/" + limit) >> set;
    if (set == bytes) {
      folder_ = folder;
    } else {
      fs::remove(folder, error);
    }
  }

  std::string folder_;
};

TEST_F(Limits, ControlGroupLimitsEndInAPictureOrInOneErrorLine) {
  int pictures = 0;
  int refusals = 0;
  for (std::size_t mebibytes = 64; mebibytes <= 320; mebibytes += 64) {
    const MemoryGroup group(mebibytes << 20);
    if (!group.is_there()) GTEST_SKIP() << "no control group for memory can be made here";
    const Output output =
        run_gatelight(square("-o {} --size 1024x1024 --spp 1 --quiet --max-depth 1", {path("a.exr")}),
                      [&] { group.enter(); });
    EXPECT_FALSE(output.killed) << mebibytes << " MiB";
    ASSERT_THAT(output.exit_code, AnyOf(0, 4)) << mebibytes << " MiB: " << output.err;
    (output.exit_code == 0 ? pictures : refusals) += 1;
    if (output.exit_code == 4) expect_failure(output, 4, {"MiB", "control group"});
  }
  EXPECT_GT(pictures, 0);
  EXPECT_GT(refusals, 0);
}

TEST_F(Limits, AThousandThreadsRenderThePictureOfOneThread) {
  for (const char* threads : {"1", "1000"})
    expect_done(
        run_gatelight(words_of("render {} --threads {} -o {} --size 64x64 --spp 4 --quiet "
                               "--reproducible --environment 1,1,1 --integrator nrc "
                               "--train-steps 16 --batch 1024",
                               {scene, threads, path(std::string(threads) + ".exr")})));
  EXPECT_TRUE(read_file(path("1.exr")) == read_file(path("1000.exr")));
  expect_failure(run_gatelight({"render", scene, "-o", path("a.exr"), "--threads", "1025"}), 1,
                 {"--threads", "1025"});
}

TEST_F(Limits, TheErrorNamesHowManyThreadsCanBeStarted) {
  if (kSanitized) GTEST_SKIP() << "sanitizers take terabytes of addresses";
  for (const rlim_t mebibytes : {1024, 2048, 3072})
    expect_failure(
        run_within(mebibytes, words_of("render {} -o {} --size 16x16 --spp 1 --quiet --threads 1000",
                                       {scene, path("a.exr")})),
        4, {"--threads 1000"});
}

TEST_F(Limits, PictureSizesAreRefusedBeforeMemoryIsAllocated) {
  if (kSanitized) GTEST_SKIP() << "sanitizers take terabytes of addresses";
  const auto render = [&](const char* size, const char* limit) {
    // Leaves a gibibyte to work in: a size that is not refused at once would not fit.
    return run_within(
        2048, square("-o {} --size {} --spp 1 --quiet --memory-limit {}", {path("a.exr"), size, limit}));
  };
  expect_failure(render("65536x65536", "0"), 1, {"4294967296", "268435456"});
  expect_failure(render("65536x4096", "1000"), 4, {"--memory-limit 1000"});
  expect_failure(render("65536x4096", "0"), 4, {"ulimit -v"});
  expect_done(render("65536x1", "0"));
  expect_done(render("1x65536", "0"));
}

using Names = Faults;

std::string encoded(const std::string& name) {
  static constexpr const char* kDigits = "0123456789ABCDEF";
  std::string text;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    text += {'%', kDigits[byte >> 4], kDigits[byte & 15]};
  }
  return text;
}

/// The tiny scene with a texture and its buffer in files of their own.
std::string with_texture(const std::string& texture_uri, const std::string& buffer_uri) {
  nlohmann::json json = nlohmann::json::parse(tiny_scene());
  json["buffers"][0]["uri"] = buffer_uri;
  json["images"] = {{{"uri", texture_uri}}};
  // The values do not matter.
  json["accessors"].push_back({{"bufferView", 0}, {"componentType", 5126}, {"count", 6}, {"type", "VEC2"}});
  json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 1;
  json["textures"] = {{{"source", 0}}};
  json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  return json.dump();
}

std::string corners() {
  const float values[18] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, -1, 0, 1, 1, 0, -1, 1, 0};
  return {reinterpret_cast<const char*>(values), sizeof values};
}

const std::vector<std::string> kNames = {
    "with some spaces",
    "ünïcödé 日本語 🙂",
    "hash # and % 100%41",
    "quote ' and \" both",
    "{0} %s %04x {}",
    "a?b=c&d;e",
    "-o",
    "new\nline",
    "tab\tand \\ backslash",
    "[brackets] *?",
    "dot.exr.d",
    "na\xefve latin-1",
};

TEST_F(Names, EveryFileNameWorksForEveryInputAndOutput) {
  // A picture for textures and the environment.
  expect_done(
      run_gatelight(square("-o {} -o {} --size 16x8 --spp 1 --quiet", {path("t.png"), path("t.exr")})));
  std::vector<float> first;
  for (const std::string& name : kNames) {
    SCOPED_TRACE(name);
    const std::filesystem::path home = folder / name;
    std::filesystem::create_directory(home);
    const auto file = [&](const std::string& extension) { return (home / (name + extension)).string(); };
    folder.write(name + "/" + name + ".bin", corners());
    const bool utf8 = name.find('\xef') == std::string::npos;
    folder.write(name + "/" + name + ".gltf", with_texture(encoded(name + ".png"), encoded(name + ".bin")));
    std::filesystem::copy_file(folder / "t.png", file(".png"));
    std::filesystem::copy_file(folder / "t.exr", file(".exr"));
    folder.write(name + "/" + name + ".toml", "spp = 2\n");
    const auto run = [&](const Words& more) {
      return run_gatelight(
          words_of("render {} --environment {} --config {} --size 16x16 --integrator nrc --train-steps 4 "
                   "--batch 256 --quiet --threads 2",
                   {file(".gltf"), file(".exr"), file(".toml")}, more));
    };
    const Output output = run({"-o", file(".out.exr"), "-o", file(".out.png"), "--stats", file(".json"),
                               "--cache-out", file(".cache"), "--checkpoint", file(".checkpoint")});
    ASSERT_EQ(output.exit_code, 0) << name << ": " << output.err;
    EXPECT_EQ(output.err, "") << name;
    const nlohmann::json stats = nlohmann::json::parse(read_file(file(".json")));
    EXPECT_EQ(stats["warnings"].size(), 0u) << name;
    if (utf8) {
      EXPECT_EQ(stats["scene"], file(".gltf"));
    }
    expect_done(run({"-o", file(".resumed.exr"), "--checkpoint", file(".checkpoint"), "--resume"}));
    expect_done(run({"-o", file(".loaded.exr"), "--cache-in", file(".cache")}));
    expect_done(run_gatelight(
        words_of("compare {} {} --error-map {} --json {}",
                 {file(".out.exr"), file(".resumed.exr"), file(".map.png"), file(".compare.json")})));
    // The same scene under another name is the same picture.
    const std::vector<float> pixels = renderer::read_image(file(".out.exr")).layers[0].values;
    if (first.empty()) first = pixels;
    EXPECT_TRUE(pixels == first) << name;
  }
}

TEST_F(Names, MissingFilesAreNamedInTheError) {
  for (const std::string& name : kNames) {
    const std::string place = path(name + "/nowhere.gltf");
    const Output output = run_gatelight({"render", place, "-o", path("a.exr"), "--quiet"});
    std::string shown = place;
    std::replace_if(
        shown.begin(), shown.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
    expect_failure(output, 2, {shown});
  }
  const std::string very_long = path(std::string(5000, 'x'));
  expect_failure(run_gatelight({"render", very_long, "-o", path("a.exr"), "--quiet"}), 2, {"scene"});
  expect_failure(run_gatelight(square("-o {} --quiet", {very_long + ".exr"})), 3, {"write"});
}

TEST_F(Names, FilesWithTheLongestNamesCanBeReplaced) {
  const auto named = [&](char letter, const std::string& extension, std::size_t length = 255) {
    return path(std::string(length - extension.size(), letter) + extension);
  };
  const auto run = [&](const Words& more) {
    return run_gatelight(
        square("-o {} --checkpoint {} --integrator nrc --train-steps 4 --batch 256 "
               "--size 16x16 --spp 2 --quiet",
               {named('a', ".exr"), named('e', ".checkpoint")}, more));
  };
  std::string first;
  for (int time = 0; time < 2; ++time) {
    expect_done(
        run({"-o", named('b', ".png"), "--stats", named('c', ".json"), "--cache-out", named('d', ".cache")}));
    EXPECT_EQ(folder.count_files(), 6u) << "the scene and five files, nothing temporary";
    const std::string bytes = read_file(named('d', ".cache"));
    EXPECT_TRUE(first.empty() || bytes == first);
    first = bytes;
  }
  expect_done(run({"--resume"}));
  expect_failure(run_gatelight(square("-o {} --quiet", {named('a', ".exr", 256)})), 3,
                 {named('a', ".exr", 256)});
}

}  // namespace
}  // namespace gatelight::tests

// Names of files.

#include <algorithm>
#include <nlohmann/json.hpp>

#include "renderer/image/image_read.h"
#include "tests/extremes/faults.h"

namespace gatelight::tests {
namespace {

class Names : public Faults {};

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

// Names of files, and textures that cannot be read.

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
  expect_done(run_gatelight(
      words({"-o", path("t.png"), "-o", path("t.exr"), "--size", "16x8", "--spp", "1", "--quiet"})));
  std::string first;
  for (const std::string& name : kNames) {
    const std::filesystem::path home = folder / name;
    std::filesystem::create_directory(home);
    const auto file = [&](const std::string& extension) { return (home / (name + extension)).string(); };
    folder.write(name + "/" + name + ".bin", corners());
    const bool utf8 = name.find('\xef') == std::string::npos;
    folder.write(name + "/" + name + ".gltf", with_texture(encoded(name + ".png"), encoded(name + ".bin")));
    std::filesystem::copy_file(folder / "t.png", file(".png"));
    std::filesystem::copy_file(folder / "t.exr", file(".exr"));
    folder.write(name + "/" + name + ".toml", "spp = 2\n");
    const auto run = [&](const std::vector<std::string>& more) {
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
    const Output resumed = run({"-o", file(".resumed.exr"), "--checkpoint", file(".checkpoint"), "--resume"});
    EXPECT_EQ(resumed.exit_code, 0) << name << ": " << resumed.err;
    const Output loaded = run({"-o", file(".loaded.exr"), "--cache-in", file(".cache")});
    EXPECT_EQ(loaded.exit_code, 0) << name << ": " << loaded.err;
    const renderer::Picture picture = renderer::read_image(file(".out.exr"));
    ASSERT_EQ(run_gatelight({"compare", file(".out.exr"), file(".resumed.exr"), "--error-map",
                             file(".map.png"), "--json", file(".compare.json")})
                  .exit_code,
              0)
        << name;
    // The same scene under another name is the same picture.
    const auto* bytes = reinterpret_cast<const char*>(picture.layers[0].values.data());
    const std::string pixels(bytes, picture.layers[0].values.size() * sizeof(float));
    if (first.empty()) first = pixels;
    EXPECT_EQ(pixels == first, true) << name;
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
  expect_failure(run_gatelight(words({"-o", very_long + ".exr", "--quiet"})), 3, {"write"});
}

TEST_F(Names, FilesWithTheLongestNamesCanBeReplaced) {
  const auto named = [&](char letter, const std::string& extension, std::size_t length = 255) {
    return path(std::string(length - extension.size(), letter) + extension);
  };
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all =
        words({"-o", named('a', ".exr"), "--checkpoint", named('e', ".checkpoint"), "--integrator", "nrc",
               "--train-steps", "4", "--batch", "256", "--size", "16x16", "--spp", "2", "--quiet"});
    all.insert(all.end(), more.begin(), more.end());
    return run_gatelight(all);
  };
  std::string first;
  for (int time = 0; time < 2; ++time) {
    expect_done(
        run({"-o", named('b', ".png"), "--stats", named('c', ".json"), "--cache-out", named('d', ".cache")}));
    EXPECT_EQ(folder.count_files(), 6u) << "the scene and five files, nothing temporary";
    const std::string bytes = read_file(named('d', ".cache"));
    EXPECT_EQ(first.empty() || bytes == first, true);
    first = bytes;
  }
  expect_done(run({"--resume"}));
  expect_failure(run_gatelight(words({"-o", named('a', ".exr", 256), "--quiet"})), 3,
                 {named('a', ".exr", 256)});
}

TEST_F(Names, EachUnreadableTextureIsReportedOnce) {
  folder.write("a.bin", corners());
  folder.write("broken.png", "\x89PNG\r\n\x1a\n not a picture");
  folder.write("missing.gltf", with_texture("nowhere.png", "a.bin"));
  folder.write("broken.gltf", with_texture("broken.png", "a.bin"));
  for (const char* file : {"missing.gltf", "broken.gltf"}) {
    const std::vector<std::string> all = words_of(
        "render {} -o {} --environment 1,1,1 --size 16x16 --spp 1 --quiet", {path(file), path("a.exr")});
    expect_failure(run_gatelight(all), 2, {path(file), ".png"});
    std::vector<std::string> warned = all;
    warned.insert(warned.end(), {"--missing", "warn", "--stats", path("s.json")});
    expect_done(run_gatelight(warned));
    const nlohmann::json stats = nlohmann::json::parse(read_file(path("s.json")));
    expect_messages(stats["warnings"], {{".png"}});
  }
}

}  // namespace
}  // namespace gatelight::tests

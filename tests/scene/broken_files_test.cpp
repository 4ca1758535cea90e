// Any file loads, or is refused with InputError in one line. Large scenes have their known contents.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "scene/gltf.h"
#include "tests/support/gltf_parts.h"
#include "tests/support/scene_fault.h"
#include "tests/support/small_pngs.h"

namespace gatelight::scene {
namespace {

/// True if it loaded.
bool loads_or_refuses(const std::filesystem::path& path, const std::string& what) {
  try {
    EXPECT_EQ(scene_fault(load_gltf(path)), "") << what;
    return true;
  } catch (const InputError& e) {
    const testing::ScopedTrace trace(__FILE__, __LINE__, what);
    tests::expect_message(e.what(), {path.filename().string()});
  } catch (const std::exception& e) {
    ADD_FAILURE() << what << ": " << e.what();
  }
  return false;
}

std::vector<std::filesystem::path> files_under(const char* folder) {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path root = std::filesystem::path(std::getenv("GATELIGHT_SCENES")) / folder;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    const std::string extension = entry.path().extension();
    if (extension == ".gltf" || extension == ".glb") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(BrokenFiles, SamplesLoadOrAreRefused) {
  if (!std::getenv("GATELIGHT_SCENES")) GTEST_SKIP() << "GATELIGHT_SCENES is not set";
  std::size_t refused = 0;
  const auto files = files_under("gltf-invalid");
  for (const auto& path : files) refused += loads_or_refuses(path, path.string()) ? 0 : 1;
  EXPECT_GT(files.size(), 50u);
  EXPECT_GT(refused, 20u);
}

TEST(BrokenFiles, FeatureSamplesLoad) {
  if (!std::getenv("GATELIGHT_SCENES")) GTEST_SKIP() << "GATELIGHT_SCENES is not set";
  for (const auto& path : files_under("gltf-features")) {
    EXPECT_TRUE(loads_or_refuses(path, path.string())) << path;
  }
}

/// A small file that passes through most of the loader.
std::vector<std::uint8_t> rich_file() {
  GltfBuilder file;
  file.add("images", {{"bufferView", file.view(kGrey)}, {"mimeType", "image/png"}});
  file.add("textures", {{"source", 0}});
  file.add("materials", {{"normalTexture",
                          {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", {2, 2}}}}}}}},
                         {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}}}});
  json primitive = file.triangle();
  primitive["material"] = 0;
  primitive["attributes"]["NORMAL"] =
      file.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3", 3);
  primitive["indices"] = file.accessor(std::vector<std::uint16_t>{0, 1, 2}, kUnsignedShort, "SCALAR", 3);
  const int mesh = file.mesh(primitive);
  const int places = file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0}, kFloat, "VEC3", 2);
  file.add("nodes", {{"mesh", mesh}, {"rotation", {0, 0, 0, 1}}});
  file.node({{"children", {0}}, {"scale", {2, 2, 2}}});
  file.node({{"mesh", mesh}, {"extensions", instancing({{"TRANSLATION", places}})}});
  file.node({{"camera", camera(file)}});
  set_lights(file, {{{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}}});
  json extensions = light_of_node(0);
  extensions["GATELIGHT_visibility"] = {{"glossy", false}};
  extensions["GATELIGHT_light_linking"]["receivers"] = {{"nodes", {0, 2}}, {"exclude", true}};
  file.node({{"extensions", extensions}});
  return file.glb();
}

class Mutation : public ::testing::Test {
 protected:
  void try_bytes(const std::vector<std::uint8_t>& bytes, const std::string& what) {
    write_bytes(path_, bytes);
    ++(loads_or_refuses(path_, what) ? loaded_ : refused_);
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "mutant.glb";
  int loaded_ = 0;
  int refused_ = 0;
};

TEST_F(Mutation, ChangedBytesAreLoadedOrRefused) {
  const std::vector<std::uint8_t> whole = rich_file();
  std::mt19937 random(20240607);
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  for (int variant = 0; variant < 4000; ++variant) {
    std::vector<std::uint8_t> bytes = whole;
    for (std::size_t flips = 1 + below(3); flips > 0; --flips) {
      std::uint8_t& byte = bytes[below(bytes.size())];
      // Digits often become other digits, so that the JSON stays valid.
      byte = byte >= '0' && byte <= '9' && below(4) != 0 ? static_cast<std::uint8_t>('0' + below(10))
                                                         : static_cast<std::uint8_t>(below(256));
    }
    try_bytes(bytes, "variant " + std::to_string(variant));
  }
  EXPECT_GT(loaded_, 100);
  EXPECT_GT(refused_, 100);
}

TEST_F(Mutation, TruncatedFilesAreRefused) {
  const std::vector<std::uint8_t> whole = rich_file();
  for (std::size_t length = 0; length < whole.size(); length += 3) {
    std::vector<std::uint8_t> bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
    if (length >= 12) {  // with the right length in the header, so that the chunks are read
      for (std::size_t i = 0; i < 4; ++i) bytes[8 + i] = static_cast<std::uint8_t>(length >> (8 * i));
    }
    try_bytes(bytes, "length " + std::to_string(length));
  }
  EXPECT_EQ(loaded_, 0);
}

TEST_F(Mutation, ChangedJsonValuesAreLoadedOrRefused) {
  const std::vector<std::uint8_t> whole = rich_file();
  const std::size_t size = whole[12] | static_cast<std::size_t>(whole[13]) << 8;
  const json original =
      json::parse(whole.begin() + 20, whole.begin() + 20 + static_cast<std::ptrdiff_t>(size));
  const std::size_t bin_start = 20 + size + 8;
  const json flat = original.flatten();
  const json values = json::parse(
      R"([null, true, -1, 0, 1, 7, 4294967295, 1e300, 0.5, "text", [], {}, [0, 1, 2], {"a": 1}])");
  for (const auto& [pointer, ignored] : flat.items()) {
    // Every value, and every container around it.
    for (std::string at = pointer; !at.empty(); at.resize(at.rfind('/'))) {
      for (const json& value : values) {
        GltfBuilder file;
        file.root = original;
        file.root[json::json_pointer(at)] = value;
        file.bin.assign(whole.begin() + static_cast<std::ptrdiff_t>(bin_start), whole.end());
        try_bytes(file.glb(), at + " = " + value.dump());
      }
    }
  }
  EXPECT_GT(loaded_, 100);
  EXPECT_GT(refused_, 1000);
}

struct Known {
  const char* file;
  std::size_t triangles;  ///< each instance counted
  Vec3 low;
  Vec3 high;
  std::size_t images;
};

TEST(RealScenes, HaveTheirKnownTrianglesAndBounds) {
  const char* scenes = std::getenv("GATELIGHT_SCENES");
  if (!scenes) GTEST_SKIP() << "GATELIGHT_SCENES is not set";
  for (const auto& [file, triangles, low, high, images] :
       {Known{"cornell/cornell-area.glb", 36, {-1, 0, -1}, {1, 2, 1}, 0},
        Known{"sponza/sponza.glb", 262267, {-12.0f, -0.8f, -7.4f}, {11.2f, 8.9f, 6.9f}, 33},
        Known{"country-kitchen/country-kitchen.glb", 1050941, {-3.1f, 0, -3.2f}, {3.8f, 3.4f, 5.5f}, 11},
        Known{"salle-de-bain/salle-de-bain.glb", 449049, {-1.7f, 0, -2.3f}, {1.7f, 3.4f, 2.3f}, 1},
        Known{"bistro-exterior/bistro-exterior.glb",
              1308885,
              {-57.9f, -1.2f, -84.6f},
              {25.1f, 26.5f, 36.0f},
              66}}) {
    SCOPED_TRACE(file);
    const Scene scene = load_gltf(std::filesystem::path(scenes) / file);
    EXPECT_THAT(scene.warnings, ::testing::IsEmpty());
    EXPECT_EQ(count_triangles(scene), triangles);
    EXPECT_LT((scene.bounds.min() - low).cwiseAbs().maxCoeff(), 0.06f) << scene.bounds.min().transpose();
    EXPECT_LT((scene.bounds.max() - high).cwiseAbs().maxCoeff(), 0.06f) << scene.bounds.max().transpose();
    EXPECT_EQ(scene.images.size(), images);
    EXPECT_FALSE(scene.cameras.empty());
    EXPECT_LT(geometry_bytes(scene), triangles * 64) << "bytes a triangle";
    for (const Instance& instance : scene.instances) {
      const Mesh& mesh = scene.mesh_of(instance);
      EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
      EXPECT_EQ(mesh.tangents.empty(), !scene.material_of(instance).normal_texture);
    }
  }
}

}  // namespace
}  // namespace gatelight::scene

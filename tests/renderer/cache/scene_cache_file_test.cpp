#include "renderer/cache/cache_file.h"

#include <gtest/gtest.h>

#include <functional>

#include "base/errors.h"
#include "base/file/content_digest.h"
#include "renderer/cache/cache_content.h"
#include "tests/support/cached_state.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {
using neural::FeatureEncoding;
using testing::any_cache_state;
using testing::same_bits;
using testing::small_model;
using tests::expect_message;
using tests::expect_refusal;
using tests::read_file;
using tests::refusal;
using tests::TemporaryFolder;

const SceneFingerprint kScene = {
    {"geometry", "a1"}, {"attributes", "b2"}, {"materials", "c3"}, {"lights", "d4"}, {"environment", "e5"}};
const RenderOptions kNrc = [] {
  RenderOptions options;
  options.integrator = Integrator::nrc;
  options.cache.min_roughness = 0.3f;
  return options;
}();

TEST(SceneCacheFile, EverythingComesBackToTheBit) {
  const TemporaryFolder folder;
  for (const FeatureEncoding encoding : {FeatureEncoding::gate, FeatureEncoding::hash_grid}) {
    const auto model = small_model(encoding);
    for (const auto& [name, options] : neural::testing::all_training_options(*model)) {
      SCOPED_TRACE(name);
      CacheState state = any_cache_state(*model, options, 1);
      if (name.size() % 2 == 0) state.triangle_counts.clear();
      write_cache_file(folder / "a", state, *model, options, {kNrc}, kScene);
      CacheFile file(folder / "a");
      EXPECT_TRUE(same_bits(file.setup(), state.setup));
      EXPECT_TRUE(same_bits(file.read_state(*model, options), state));
      const std::string bytes = read_file(folder / "a");
      write_cache_file(folder / "a", state, *model, options, {kNrc}, kScene);
      EXPECT_EQ(read_file(folder / "a"), bytes);
      EXPECT_EQ(folder.count_files(), 1u);
    }
  }
}

TEST(SceneCacheFile, FilesOfOtherOptionsOrScenesAreRefusedByName) {
  const TemporaryFolder folder;
  const auto model = small_model();
  const CacheState state = any_cache_state(*model, {}, 1);
  const CacheMeaning nrc{kNrc};
  RenderOptions occlusion;
  occlusion.integrator = Integrator::nao;
  const CacheMeaning nao{occlusion, 0.5f};
  write_cache_file(folder / "nrc", state, *model, {}, nrc, kScene);
  write_cache_file(folder / "nao", state, *model, {}, nao, kScene);
  const auto opening = [&](const char* name, const CacheMeaning& meaning, const SceneFingerprint& scene,
                           std::size_t instances) {
    return refusal<CacheFileError>([&] { CacheFile(folder / name).expect(meaning, scene, instances); });
  };
  EXPECT_EQ(opening("nrc", nrc, kScene, 5), "");
  EXPECT_EQ(opening("nao", nao, kScene, 5), "");

  RenderOptions other = kNrc;
  other.cache.component = CachedComponent::indirect;
  const std::string one = opening("nrc", {other}, kScene, 5);
  expect_message(one, {(folder / "nrc").string(), "cache-holds", "no-delta", "indirect"});
  EXPECT_FALSE(tests::has_name(one, "cache-roughness"));
  other.cache.min_roughness = 0.1f;
  expect_message(opening("nrc", {other}, kScene, 5),
                 {"cache-holds", "no-delta", "indirect", "cache-roughness", "0.3", "0.1"});
  other = kNrc;
  other.cache.encoding = FeatureEncoding::hash_grid;
  expect_message(opening("nrc", {other}, kScene, 5), {"encoding", "gate", "hashgrid"});
  other = kNrc;
  other.cache.node_spacing = 0.2f;
  expect_message(opening("nrc", {other}, kScene, 5), {"node-spacing", "0.1", "0.2"});
  other.cache.node_spacing = state.setup.node_spacing;
  EXPECT_EQ(opening("nrc", {other}, kScene, 5), "");
  expect_message(opening("nrc", nao, kScene, 5),
                 {"integrator", "nrc", "nao", "ao-distance", "0.5", "cache-holds", "no-delta"});
  expect_message(opening("nao", {occlusion, 0.25f}, kScene, 5), {"ao-distance", "0.5", "0.25"});

  expect_message(opening("nrc", nrc, kScene, 4), {"5", "4"});
  SceneFingerprint scene = kScene;
  scene[3].text = scene[4].text = "f6";
  expect_message(opening("nrc", nrc, scene, 5), {"lights", "environment"});
  EXPECT_EQ(opening("nao", nao, scene, 5), "") << "light does not change occlusion";
  scene[0].text = "f6";
  expect_message(opening("nao", nao, scene, 5), {"geometry"});
}

TEST(SceneCacheFile, ImpossibleSetupsAreRefused) {
  const TemporaryFolder folder;
  const auto model = small_model();
  const auto opening = [&](const std::function<void(CacheState&)>& change) {
    CacheState state = any_cache_state(*model, {}, 1);
    change(state);
    write_cache_file(folder / "a", state, *model, {}, {kNrc}, kScene);
    return refusal<CacheFileError>([&] { CacheFile(folder / "a").read_state(*model, {}); });
  };
  expect_message(opening([](CacheState& s) { s.setup.sides[3] = static_cast<neural::Sides>(4); }),
                 {"renderer.sides", "3", "4"});
  expect_message(opening([](CacheState& s) { s.setup.node_spacing = 0.0f; }), {"renderer.scales", "0"});
  expect_message(opening([](CacheState& s) { s.setup.target_scale = NAN; }), {"renderer.scales", "1", "nan"});
  expect_message(opening([](CacheState& s) { s.setup.records_per_path = INFINITY; }),
                 {"renderer.scales", "2", "inf"});
  expect_message(opening([](CacheState& s) { s.steps = 1ull << 31; }), {"renderer.steps", "2147483648"});
}

TEST(SceneCacheFile, ForeignFilesAreRefused) {
  const TemporaryFolder folder;
  const auto model = small_model();
  neural::write_model_file(folder / "model", *model, {}, neural::initial_state(*model, {}), "");
  expect_refusal<CacheFileError>([&] { CacheFile(folder / "model"); },
                                 {"format", "gatelight-cache", "gatelight-scene-cache"});
  expect_refusal<CacheFileError>([&] { CacheFile(folder / "none"); }, {"/none"});
  expect_refusal<CacheFileError>([&] { CacheFile(folder.write("text", "no cache")); }, {"/text"});
}

TEST(SceneCacheFile, AnotherVersionAndAFileWithoutADigestAreRefused) {
  const TemporaryFolder folder;
  const auto model = small_model();
  const CacheState state = any_cache_state(*model, {}, 1);
  CacheContent content;
  fill_cache_content(content, *model, {}, state);
  Metadata metadata = content.model.metadata;
  metadata.insert({{"format", "gatelight-scene-cache"}, {"version", "2"}});
  write_safetensors(folder / "a", content.tensors, metadata);
  expect_refusal<CacheFileError>([&] { CacheFile(folder / "a"); }, {"version", "2", "3"});
  metadata["version"] = "3";
  write_safetensors(folder / "a", content.tensors, metadata);
  expect_refusal<CacheFileError>([&] { CacheFile(folder / "a"); }, {"digest"});
}

// The setup in the file decides the number of nodes of the model: the tensors must have that size.
TEST(SceneCacheFile, ATensorThatIsTooShortForTheModelIsRefusedBeforeAllocation) {
  const TemporaryFolder folder;
  const auto model = small_model();
  const CacheState state = any_cache_state(*model, {}, 1);
  CacheContent content;
  fill_cache_content(content, *model, {}, state);
  for (TensorView& tensor : content.tensors) {
    if (tensor.name != "features") continue;
    tensor.shape[0] = 1;
    tensor.data = tensor.data.first(4 * tensor.shape[1]);
  }
  Metadata metadata = content.model.metadata;
  metadata.insert({{"format", "gatelight-scene-cache"}, {"version", "3"}});
  metadata[kDigestKey] = content_digest(content.tensors, metadata);
  write_safetensors(folder / "a", content.tensors, metadata);
  const CacheFile file(folder / "a");
  expect_refusal<CacheFileError>([&] { file.expect_model(*model, {}); }, {"features", "F32 [1, 1]"});
}

}  // namespace
}  // namespace gatelight::renderer

// Cache files of another model, other options or another scene are refused, and the message has the
// difference.

#include <gtest/gtest.h>

#include <functional>
#include <utility>
#include <vector>

#include "tests/neural/model/cache_files.h"
#include "tests/support/small_surfaces.h"

namespace gatelight::neural::testing {
namespace {

using Change = std::function<void(ModelConfig&)>;

TEST(CacheFileMismatch, AFeatureThatIsNotExactInFp16IsRefused) {
  const TemporaryFolder folder;
  const ModelCase c = find_model_case("nrc");
  const TrainingOptions options{.precision = FeaturePrecision::fp16};
  Trainer trainer = make_trainer(c, options, 1);
  ModelState state = state_of(trainer);
  state.parameters[5] = 0.1f;
  trainer.backend().import_state(state);
  expect_refusal<BadConfiguration>([&] { trainer.save(folder / "a", kFingerprint); }, {"features[5]", "0.1"});
  EXPECT_EQ(folder.count_files(), 0u);
}

TEST(CacheFileMismatch, AnotherConfigurationIsRefusedWithTheDifference) {
  const TemporaryFolder folder;
  struct Case {
    Change change;
    NameList names;
    ModelConfig base = default_gate_config();
  };
  const ModelConfig hash = default_hash_config(), plain = default_plain_config();
  const std::vector<Case> cases = {
      {[](ModelConfig& c) { c.mlp.width = 64; }, {"hidden width", "64", "32"}},
      {[](ModelConfig& c) { c.mlp.hidden_layers = 3; }, {"hidden layers", "3", "2"}},
      {[](ModelConfig& c) { c.mlp.outputs = 1; }, {"outputs", "1", "3"}},
      {[](ModelConfig& c) { c.mlp.biases = false; }, {"biases", "false", "true"}},
      {[](ModelConfig& c) { c.mlp.leaky_slope = 0.2f; }, {"leaky slope", "0.2", "0.01"}},
      {[](ModelConfig& c) { c.auxiliary[0].size = 8; },
       {"inputs", "direction one_blob 8", "direction one_blob 4"}},
      {[](ModelConfig& c) { c.auxiliary.clear(); }, {"inputs", "direction one_blob 4"}},
      {[](ModelConfig& c) { c.encoding = FeatureEncoding::hash_grid; }, {"encoding", "hash_grid", "gate"}},
      {[](ModelConfig& c) { c.gate.features = 4; }, {"features", "4", "8"}},
      {[](ModelConfig& c) { c.gate.stack = {kAdaptive}; }, {"levels", "1", "2"}},
      {[](ModelConfig& c) {
         c.gate.stack = {kAdaptive, 2};
       },
       {"stack", "adaptive, 2", "adaptive, 1"}},
      {[](ModelConfig& c) { c.gate.node_spacing = 0.1f; }, {"node spacing", "0.1", "0.3"}},
      {[](ModelConfig& c) { c.gate.rule = ResolutionRule::fixed; }, {"rule", "fixed", "uniform"}},
      {[](ModelConfig& c) {
         c.gate.storage = NodeStorage::per_triangle;
         c.gate.cluster = false;
       },
       {"storage", "per_triangle", "shared"}},
      {[](ModelConfig& c) { c.hash_grid.log2_table_size = 9; }, {"log2 table size", "9", "10"}, hash},
      {[](ModelConfig& c) { c.hash_grid.growth = 1.5f; }, {"growth", "1.5", "2"}, hash},
      {[](ModelConfig& c) { c.hash_grid.bounds_max[1] = 10; }, {"bounds max y", "10", "1"}, hash},
      {[](ModelConfig& c) { c.hash_grid.bounds_min[2] = -0.75f; }, {"bounds min z", "-0.75", "-0.5"}, hash},
      // A position is an input: the bounds count without a hash grid, too.
      {[](ModelConfig& c) { c.hash_grid.bounds_min[0] = -5; }, {"bounds min x", "-5", "-1"}, plain},
  };
  for (const Case& c : cases) {
    Trainer trainer = make_trainer(make_case("model", c.base), {}, 2);
    const ModelState before = state_of(trainer);
    ModelConfig config = c.base;
    c.change(config);
    make_trainer(make_case("file", config), {}, 1).save(folder / "a", kFingerprint);
    expect_load_refused(trainer, folder / "a", c.names);
    EXPECT_TRUE(same_bits(state_of(trainer), before));
  }
}

TEST(CacheFileMismatch, OtherSurfacesUnderEqualOptionsAreRefused) {
  const TemporaryFolder folder;
  OwnedSurfaces surfaces = *make_small_surfaces();
  make_trainer({"file", make_model(default_gate_config(), surfaces.layout())}, {}, 1)
      .save(folder / "a", kFingerprint);
  std::swap(surfaces.meshes[1].triangles[0], surfaces.meshes[1].triangles[1]);
  Trainer trainer = make_trainer({"model", make_model(default_gate_config(), surfaces.layout())}, {}, 2);
  expect_load_refused(trainer, folder / "a", {"surfaces"});
}

TEST(CacheFileMismatch, OptionsWithOtherArraysAreRefusedAndOnlyThose) {
  const TemporaryFolder folder;
  using OptionsChange = std::function<void(TrainingOptions&)>;
  const std::vector<std::pair<OptionsChange, NameList>> cases = {
      {[](TrainingOptions& o) { o.precision = FeaturePrecision::fp16; },
       {"feature precision", "fp16", "fp32"}},
      {[](TrainingOptions& o) { o.update = FeatureUpdate::dense; }, {"feature update", "dense", "sparse"}},
      {[](TrainingOptions& o) { o.count_triangles = true; }, {"triangle counts", "true", "false"}},
      {[](TrainingOptions& o) { o.feature_step = FeatureStep::per_triangle; },
       {"triangle counts", "true", "false"}},
      {[](TrainingOptions& o) { o.average.network = false; }, {"average of network", "false", "true"}},
      {[](TrainingOptions& o) { o.average.features = false; }, {"average of features", "false", "true"}},
      {[](TrainingOptions& o) { o.adam.learning_rate = 1e-3f; }, {}},
      {[](TrainingOptions& o) { o.loss = Loss::l2; }, {}},
      {[](TrainingOptions& o) { o.seed = 7; }, {}},
  };
  const ModelCase c = find_model_case("nrc");
  for (const auto& [change, names] : cases) {
    TrainingOptions options;
    change(options);
    make_trainer(c, options, 1).save(folder / "a", kFingerprint);
    Trainer trainer = make_trainer(c, {}, 2);
    if (names.empty()) {
      trainer.load(folder / "a", kFingerprint);
    } else {
      expect_load_refused(trainer, folder / "a", names);
    }
  }
}

TEST(CacheFileMismatch, AnotherFingerprintIsRefused) {
  const TemporaryFolder folder;
  const ModelCase c = tiny_case();
  make_trainer(c, {}, 1).save(folder / "a", "one");
  Trainer trainer = make_trainer(c, {}, 2);
  const ModelState before = state_of(trainer);
  expect_load_refused(trainer, folder / "a", {"fingerprint", "one", "two"}, "two");
  EXPECT_TRUE(same_bits(state_of(trainer), before));
  trainer.load(folder / "a", "one");
  EXPECT_FALSE(same_bits(state_of(trainer), before));
}

}  // namespace
}  // namespace gatelight::neural::testing

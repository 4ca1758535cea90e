#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <fstream>
#include <functional>
#include <initializer_list>

#include "base/errors.h"
#include "base/file/safetensors.h"
#include "neural/cpu/cpu_backend.h"
#include "neural/model/model_file.h"
#include "neural/trainer.h"
#include "tests/support/messages.h"
#include "tests/support/model_cases.h"
#include "tests/support/stored_state.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::neural::testing {
namespace {

using gatelight::tests::expect_refusal;
using gatelight::tests::NameList;
using gatelight::tests::Place;
using gatelight::tests::read_file;
using gatelight::tests::refusal;
using gatelight::tests::TemporaryFolder;

constexpr const char* kFingerprint = "scene 1234";

using Change = std::function<void(ModelConfig&)>;

Trainer make_trainer(const ModelCase& c, const TrainingOptions& options, std::uint64_t seed) {
  return {c.model, options,
          std::make_unique<StoredState>(c.model, options, any_state(*c.model, options, seed))};
}

ModelState state_of(const Trainer& trainer) {
  return trainer.backend().export_state();
}

void expect_load_refused(Trainer& trainer, const std::filesystem::path& path, NameList names,
                         const std::string& fingerprint = kFingerprint, Place place = Place::current()) {
  names.push_back(path.string());
  expect_refusal<CacheFileError>([&] { trainer.load(path, fingerprint); }, names, place);
}

/// Writes a file of version 1, which has no digest, so tests can edit it.
void save_version_1(const Trainer& trainer, const std::filesystem::path& path) {
  const ModelState state = state_of(trainer);
  ModelContent content = make_model_content(trainer.model(), {}, state);
  content.metadata.insert({{"format", "gatelight-cache"}, {"version", "1"}, {"fingerprint", kFingerprint}});
  write_safetensors(path, content.tensors, content.metadata);
}

/// A model with few nodes, because tests load mutations of every byte.
ModelCase tiny_case() {
  ModelConfig config = default_plain_config();
  config.mlp.width = 16;
  config.mlp.hidden_layers = 1;
  config.mlp.outputs = 1;
  return make_case("tiny", config);
}

TEST(CacheFile, EveryConfigurationIsRestoredBitForBit) {
  const TemporaryFolder folder;
  for (const char* name :
       {"nrc", "nao", "gate_L2_per_triangle", "gate_only", "mlp_5x16_no_biases", "outputs_16", "hash_F4",
        "hash_memory_target", "plain_256_inputs", "gate_with_position"}) {
    const ModelCase c = find_model_case(name);
    for (const auto& [options_name, options] : all_training_options(*c.model)) {
      SCOPED_TRACE(std::string(name) + " " + options_name);
      const Trainer saved = make_trainer(c, options, 1);
      saved.save(folder / "a", kFingerprint);
      Trainer loaded = make_trainer(c, options, 2);
      ASSERT_FALSE(same_bits(state_of(loaded), state_of(saved)));
      loaded.load(folder / "a", kFingerprint);
      EXPECT_TRUE(same_bits(state_of(loaded), state_of(saved)));
    }
  }
}

// The file holds all state that training changes: a loaded cache trains on like one that was never saved.
TEST(CacheFile, TrainingContinuesBitForBit) {
  const TemporaryFolder folder;
  for (const char* name : {"nrc", "nao", "hash_F4", "plain_256_inputs"}) {
    const ModelCase c = find_model_case(name);
    const OwnedBatch batches[] = {make_batch(*c.model, 300, 1), make_batch(*c.model, 300, 2)};
    for (const auto& [options_name, options] : all_training_options(*c.model)) {
      SCOPED_TRACE(std::string(name) + " " + options_name);
      const auto learner = [&] { return Trainer(c.model, options, cpu::make_cpu_backend(c.model, options)); };
      Trainer straight = learner();
      for (int step = 0; step < 6; ++step) {
        if (step == 3) straight.save(folder / "a", kFingerprint);
        straight.train(batches[step % 2].training());
      }
      Trainer loaded = learner();
      loaded.train(batches[1].training());
      loaded.load(folder / "a", kFingerprint);
      for (int step = 3; step < 6; ++step) loaded.train(batches[step % 2].training());
      EXPECT_TRUE(same_bits(state_of(loaded), state_of(straight)));
    }
  }
}

TEST(CacheFile, HundredStepsMakeTheSameFileForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  for (const char* name : {"nrc", "nao", "hash_F4"}) {
    const ModelCase c = find_model_case(name);
    const OwnedBatch batches[] = {make_batch(*c.model, 4001, 1), make_batch(*c.model, 3000, 2)};
    std::string first;
    for (const int threads : {1, 2, 7}) {
      const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                        static_cast<std::size_t>(threads));
      tbb::task_arena(threads).execute([&] {
        Trainer trainer(c.model, {}, cpu::make_cpu_backend(c.model, {}));
        for (int step = 0; step < 100; ++step) trainer.train(batches[step % 2].training());
        trainer.save(folder / "a", kFingerprint);
      });
      const std::string bytes = read_file(folder / "a");
      if (threads == 1) first = bytes;
      EXPECT_TRUE(bytes == first) << name << " with " << threads << " threads";
    }
  }
}

TEST(CacheFile, EqualStatesMakeEqualBytesAndOthersDoNot) {
  const TemporaryFolder folder;
  const ModelCase c = find_model_case("nrc");
  const TrainingOptions options;
  make_trainer(c, options, 1).save(folder / "a", kFingerprint);
  make_trainer(find_model_case("nrc"), options, 1).save(folder / "b", kFingerprint);
  make_trainer(c, options, 2).save(folder / "c", kFingerprint);
  EXPECT_EQ(read_file(folder / "a"), read_file(folder / "b"));
  EXPECT_NE(read_file(folder / "a"), read_file(folder / "c"));
}

TEST(CacheFile, HalfFeaturesTakeHalfTheBytes) {
  const TemporaryFolder folder;
  const ModelCase c = find_model_case("nrc");
  TrainingOptions options;
  options.precision = FeaturePrecision::fp16;
  const Trainer trainer = make_trainer(c, options, 1);
  trainer.save(folder / "a", kFingerprint);
  const ParameterLayout& layout = c.model->parameters;
  const std::array<std::uint64_t, 2> shape = {layout.node_count, layout.features};
  std::vector<std::uint16_t> halves(layout.network);
  SafetensorsReader(folder / "a")
      .read("features", TensorType::f16, shape, std::as_writable_bytes(std::span(halves)));
  const ModelState state = state_of(trainer);
  for (std::uint64_t i = 0; i < layout.network; ++i) ASSERT_EQ(half_to_float(halves[i]), state.parameters[i]);
}

TEST(CacheFile, AFeatureThatIsNotExactInFp16IsRefused) {
  const TemporaryFolder folder;
  const ModelCase c = find_model_case("nrc");
  TrainingOptions options;
  options.precision = FeaturePrecision::fp16;
  Trainer trainer = make_trainer(c, options, 1);
  ModelState state = state_of(trainer);
  state.parameters[5] = 0.1f;
  trainer.backend().import_state(state);
  expect_refusal<BadConfiguration>([&] { trainer.save(folder / "a", kFingerprint); }, {"features[5]", "0.1"});
  EXPECT_EQ(folder.count_files(), 0u);
}

TEST(CacheFile, AnotherConfigurationIsRefusedWithTheDifference) {
  const TemporaryFolder folder;
  struct Case {
    Change change;
    NameList names;
  };
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
  };
  Trainer trainer = make_trainer(make_case("model", default_gate_config()), {}, 2);
  const ModelState before = state_of(trainer);
  for (const Case& c : cases) {
    ModelConfig config = default_gate_config();
    c.change(config);
    make_trainer(make_case("file", config), {}, 1).save(folder / "a", kFingerprint);
    expect_load_refused(trainer, folder / "a", c.names);
    EXPECT_TRUE(same_bits(state_of(trainer), before));
  }
}

TEST(CacheFile, AnotherHashGridIsRefusedWithTheDifference) {
  const TemporaryFolder folder;
  const std::vector<std::pair<Change, NameList>> cases = {
      {[](ModelConfig& c) { c.hash_grid.log2_table_size = 9; }, {"log2 table size", "9", "10"}},
      {[](ModelConfig& c) { c.hash_grid.growth = 1.5f; }, {"growth", "1.5", "2"}},
      {[](ModelConfig& c) { c.hash_grid.bounds_max[1] = 10; }, {"bounds max y", "10", "1"}},
      {[](ModelConfig& c) { c.hash_grid.bounds_min[2] = -0.75f; }, {"bounds min z", "-0.75", "-0.5"}},
  };
  for (const auto& [change, names] : cases) {
    ModelConfig config = default_hash_config();
    change(config);
    make_trainer(make_case("file", config), {}, 1).save(folder / "a", kFingerprint);
    Trainer trainer = make_trainer(make_case("model", default_hash_config()), {}, 2);
    expect_load_refused(trainer, folder / "a", names);
  }
}

TEST(CacheFile, BoundsOfAPositionInputCountWithoutAHashGridToo) {
  const TemporaryFolder folder;
  ModelConfig config = default_plain_config();
  make_trainer(make_case("file", config), {}, 1).save(folder / "a", kFingerprint);
  config.hash_grid.bounds_min[0] = -5;
  Trainer trainer = make_trainer(make_case("model", config), {}, 2);
  expect_load_refused(trainer, folder / "a", {"bounds min x", "-1", "-5"});
}

TEST(CacheFile, OtherSurfacesUnderEqualOptionsAreRefused) {
  const TemporaryFolder folder;
  OwnedSurfaces surfaces = *make_small_surfaces();
  make_trainer({"file", make_model(default_gate_config(), surfaces.layout())}, {}, 1)
      .save(folder / "a", kFingerprint);
  std::swap(surfaces.meshes[1].triangles[0], surfaces.meshes[1].triangles[1]);
  Trainer trainer = make_trainer({"model", make_model(default_gate_config(), surfaces.layout())}, {}, 2);
  expect_load_refused(trainer, folder / "a", {"surfaces"});
}

TEST(CacheFile, OptionsWithOtherArraysAreRefusedAndOnlyThose) {
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

TEST(CacheFile, AnotherFingerprintIsRefused) {
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

/// Replaces a text of the file's header by another of the same length.
void replace(const std::filesystem::path& path, const std::string& from, const std::string& to) {
  ASSERT_EQ(from.size(), to.size());
  std::string bytes = read_file(path);
  const std::size_t place = bytes.find(from);
  ASSERT_NE(place, std::string::npos) << from;
  bytes.replace(place, from.size(), to);
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST(CacheFile, AForeignFileAndAnotherVersionAreRefused) {
  const TemporaryFolder folder;
  const ModelCase c = tiny_case();
  Trainer trainer = make_trainer(c, {}, 2);
  const auto expect_refused = [&](const std::string& from, const std::string& to, const NameList& names) {
    save_version_1(make_trainer(c, {}, 1), folder / "a");
    replace(folder / "a", from, to);
    expect_load_refused(trainer, folder / "a", names);
  };
  expect_refused(R"("version":"1")", R"("version":"3")", {"version", "3", "2"});
  expect_refused(R"("version":"1")", R"("version":"2")", {"digest"});
  expect_refused(R"("format":"gate)", R"("format":"Gate)", {"format", "Gatelight-cache"});
  expect_refused(R"("format")", R"("formaT")", {"format"});
  expect_refused(R"("network")", R"("netwOrk")", {"network"});
  expect_refused(R"("network":"{)", R"("network":"[)", {"network"});
  expect_refused(R"("steps")", R"("sTeps")", {"steps"});
  write_safetensors(folder / "a", {}, {{"format", "pt"}});
  expect_load_refused(trainer, folder / "a", {"format", "pt"});
}

TEST(CacheFile, ATensorTooManyIsRefused) {
  const TemporaryFolder folder;
  const ModelCase c = tiny_case();
  save_version_1(make_trainer(c, {}, 1), folder / "a");
  std::string bytes = read_file(folder / "a");
  std::uint64_t length = 0;
  std::memcpy(&length, bytes.data(), 8);
  const std::string data_bytes = std::to_string(bytes.size() - 8 - length);
  std::string header = bytes.substr(8, length);
  header.insert(header.find_last_of('}'), R"(,"more":{"dtype":"F32","shape":[0],"data_offsets":[)" +
                                              data_bytes + "," + data_bytes + "]}");
  length = header.size();
  std::memcpy(bytes.data(), &length, 8);
  folder.write("b", bytes.substr(0, 8) + header + bytes.substr(bytes.size() - std::stoul(data_bytes)));
  Trainer trainer = make_trainer(c, {}, 2);
  expect_load_refused(trainer, folder / "b", {"more"});
}

TEST(CacheFile, NonFiniteStatesAndNegativeSecondMomentsAreRefused) {
  const TemporaryFolder folder;
  const ModelCase c = tiny_case();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  struct Case {
    std::vector<float> ModelState::*array;
    float value;
    NameList names;
  };
  for (const Case& bad : std::initializer_list<Case>{
           {&ModelState::parameters, kNan, {"layers.0.weight", "7", "nan"}},
           {&ModelState::parameters, -kInfinity, {"layers.0.weight", "7", "-inf"}},
           {&ModelState::averages, kInfinity, {"average.layers.0.weight", "7", "inf"}},
           {&ModelState::first_moments, kNan, {"first_moment.layers.0.weight", "7", "nan"}},
           {&ModelState::second_moments, kNan, {"second_moment.layers.0.weight", "7", "nan"}},
           {&ModelState::first_moments, -kInfinity, {"first_moment.layers.0.weight", "7", "-inf"}},
           {&ModelState::second_moments, kInfinity, {"second_moment.layers.0.weight", "7", "inf"}},
           {&ModelState::second_moments, -1.0f, {"second_moment.layers.0.weight", "7", "-1"}}}) {
    Trainer broken = make_trainer(c, {}, 1);
    ModelState state = state_of(broken);
    (state.*bad.array)[7] = bad.value;
    broken.backend().import_state(state);
    broken.save(folder / "a", kFingerprint);
    Trainer trainer = make_trainer(c, {}, 2);
    const ModelState before = state_of(trainer);
    expect_load_refused(trainer, folder / "a", bad.names);
    EXPECT_TRUE(same_bits(state_of(trainer), before));
  }
}

TEST(CacheFile, EveryTruncationIsRefused) {
  const TemporaryFolder folder;
  const ModelCase c = tiny_case();
  make_trainer(c, {}, 1).save(folder / "a", kFingerprint);
  const std::string bytes = read_file(folder / "a");
  Trainer trainer = make_trainer(c, {}, 2);
  const ModelState before = state_of(trainer);
  for (std::size_t size = 0; size < bytes.size(); size += size < 4096 ? 1 : 7) {
    std::filesystem::remove(folder / "b");  // an overwritten file may be flushed to the disk at once
    folder.write("b", bytes.substr(0, size));
    ASSERT_NE(refusal<CacheFileError>([&] { trainer.load(folder / "b", kFingerprint); }), "")
        << size << " of " << bytes.size();
  }
  folder.write("b", bytes + '\0');
  EXPECT_NE(refusal<CacheFileError>([&] { trainer.load(folder / "b", kFingerprint); }), "");
  EXPECT_TRUE(same_bits(state_of(trainer), before));
}

TEST(CacheFile, EveryChangedByteIsRefused) {
  const TemporaryFolder folder;
  const ModelCase c = tiny_case();
  make_trainer(c, {}, 1).save(folder / "a", kFingerprint);
  const std::string bytes = read_file(folder / "a");
  Trainer trainer = make_trainer(c, {}, 2);
  const ModelState before = state_of(trainer);
  for (std::size_t place = 0; place < bytes.size(); ++place) {
    const auto put = [&](int byte) {
      std::fstream(folder / "a", std::ios::binary | std::ios::in | std::ios::out)
          .seekp(static_cast<std::streamoff>(place))
          .put(static_cast<char>(byte));
    };
    for (const int flip : {1 << place % 8, 0xff}) {
      put(bytes[place] ^ flip);
      ASSERT_NE(refusal<CacheFileError>([&] { trainer.load(folder / "a", kFingerprint); }), "")
          << "byte " << place << " of " << bytes.size() << ", " << flip;
    }
    put(bytes[place]);
  }
  EXPECT_TRUE(same_bits(state_of(trainer), before));
}

TEST(CacheFile, AFileOfTheVersionWithoutADigestIsStillRead) {
  const TemporaryFolder folder;
  const ModelCase c = tiny_case();
  const Trainer saved = make_trainer(c, {}, 1);
  save_version_1(saved, folder / "a");
  Trainer trainer = make_trainer(c, {}, 2);
  trainer.load(folder / "a", kFingerprint);
  EXPECT_TRUE(same_bits(state_of(trainer), state_of(saved)));
}

// Recursive functions print and compare nested values.
TEST(CacheFile, DeepNestingInTheMetadataIsRefused) {
  const TemporaryFolder folder;
  const ModelCase c = tiny_case();
  Trainer trainer = make_trainer(c, {}, 2);
  const std::string deep = std::string(200000, '[') + std::string(200000, ']');
  write_safetensors(
      folder / "a", {},
      {{"format", "gatelight-cache"}, {"version", "1"}, {"network", "{\"levels\":" + deep + "}"}});
  expect_load_refused(trainer, folder / "a", {"network", "levels"});
}

TEST(CacheFile, ARefusalIsOneLineWhateverTheFileHolds) {
  const TemporaryFolder folder;
  write_safetensors(folder / "a", {}, {{"format", "\x1b[31mred\n\r" + std::string(100000, 'x')}});
  Trainer trainer = make_trainer(tiny_case(), {}, 2);
  const std::string what = refusal<CacheFileError>([&] { trainer.load(folder / "a", kFingerprint); });
  tests::expect_names(what, {(folder / "a").string(), "format", "[31mred"});
  EXPECT_LT(what.size(), 1500u);
}

TEST(Trainer, RefusesMissingPartsAndBadOptions) {
  const ModelCase c = tiny_case();
  const auto held = [&] { return std::make_unique<StoredState>(c.model, TrainingOptions{}, ModelState{}); };
  EXPECT_THROW(Trainer(nullptr, {}, held()), BadConfiguration);
  EXPECT_THROW(Trainer(c.model, {}, nullptr), BadConfiguration);
  TrainingOptions options;
  options.adam.beta1 = 1.0f;
  EXPECT_THROW(Trainer(c.model, options, held()), BadConfiguration);
}

TEST(Trainer, ForwardsCallsToItsBackend) {
  const ModelCase c = tiny_case();
  Trainer trainer = make_trainer(c, {}, 1);
  const std::uint64_t steps = state_of(trainer).steps;
  const OwnedBatch batch = make_batch(*c.model, 5, 1);
  EXPECT_EQ(trainer.train(batch.training()).records, 5u);
  EXPECT_EQ(state_of(trainer).steps, steps + 1);
  std::vector<float> out(5);
  trainer.query(batch.points(), {}, out);
  EXPECT_EQ(out[4], static_cast<float>(steps + 1));
  EXPECT_EQ(&trainer.model(), c.model.get());
}

}  // namespace
}  // namespace gatelight::neural::testing

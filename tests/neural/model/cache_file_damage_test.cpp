// Foreign, damaged and malicious cache files are refused.

#include <gtest/gtest.h>

#include <fstream>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "tests/neural/model/cache_files.h"

namespace gatelight::neural::testing {
namespace {

TEST(DamagedCacheFile, AForeignFileAndAnotherVersionAreRefused) {
  const TemporaryFolder folder;
  const ModelCase c = tiny_case();
  Trainer trainer = make_trainer(c, {}, 2);
  const auto expect_refused = [&](const std::function<void(ModelContent&)>& edit, const NameList& names) {
    save_edited(make_trainer(c, {}, 1), folder / "a", edit);
    expect_load_refused(trainer, folder / "a", names);
  };
  const auto text = [](const char* key, const char* value) {
    return [=](ModelContent& content) { content.metadata[key] = value; };
  };
  const auto without = [](const char* key) {
    return [=](ModelContent& content) { content.metadata.erase(key); };
  };
  expect_refused(text("version", "3"), {"version", "3", "2"});
  expect_refused(text("version", "1"), {"version", "1", "2"});
  write_safetensors(folder / "a", {}, {{"format", "gatelight-cache"}, {"version", "2"}});
  expect_load_refused(trainer, folder / "a", {"digest"});
  expect_refused(text("format", "Gatelight-cache"), {"format", "Gatelight-cache"});
  expect_refused(without("format"), {"format"});
  expect_refused(without("network"), {"network"});
  expect_refused(text("network", "[}"), {"network"});
  expect_refused([](ModelContent& content) { content.tensors.pop_back(); }, {"steps"});
  expect_refused(
      [](ModelContent& content) { content.tensors.push_back({.name = "more", .shape = {0}, .data = {}}); },
      {"more"});
  write_safetensors(folder / "a", {}, {{"format", "pt"}});
  expect_load_refused(trainer, folder / "a", {"format", "pt"});
}

TEST(DamagedCacheFile, NonFiniteStatesAndNegativeSecondMomentsAreRefused) {
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
           {&ModelState::averages, kInfinity, {"average.layers.0.weight", "7", "inf"}},
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

/// The file "a" in its folder, and its bytes.
struct SavedCache {
  SavedCache() {
    make_trainer(model, {}, 1).save(folder / "a", kFingerprint);
    bytes = read_file(folder / "a");
  }

  TemporaryFolder folder;
  ModelCase model = tiny_case();
  std::string bytes;
};

TEST(DamagedCacheFile, EveryTruncationIsRefused) {
  const SavedCache saved;
  const TemporaryFolder& folder = saved.folder;
  const std::string& bytes = saved.bytes;
  Trainer trainer = make_trainer(saved.model, {}, 2);
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

TEST(DamagedCacheFile, EveryChangedByteIsRefused) {
  const SavedCache saved;
  const TemporaryFolder& folder = saved.folder;
  const std::string& bytes = saved.bytes;
  Trainer trainer = make_trainer(saved.model, {}, 2);
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

// Recursive functions print and compare nested values.
TEST(DamagedCacheFile, DeepNestingInTheMetadataIsRefused) {
  const TemporaryFolder folder;
  const ModelCase c = tiny_case();
  Trainer trainer = make_trainer(c, {}, 2);
  const std::string deep = std::string(200000, '[') + std::string(200000, ']');
  write_with_digest(
      folder / "a", {},
      {{"format", "gatelight-cache"}, {"version", "2"}, {"network", "{\"levels\":" + deep + "}"}});
  expect_load_refused(trainer, folder / "a", {"network", "levels"});
}

TEST(DamagedCacheFile, ARefusalIsOneLineWhateverTheFileHolds) {
  const TemporaryFolder folder;
  write_safetensors(folder / "a", {}, {{"format", "\x1b[31mred\n\r" + std::string(100000, 'x')}});
  Trainer trainer = make_trainer(tiny_case(), {}, 2);
  const std::string what = refusal<CacheFileError>([&] { trainer.load(folder / "a", kFingerprint); });
  tests::expect_message(what, {(folder / "a").string(), "format", "[31mred"});
  EXPECT_LT(what.size(), 1500u);
}

}  // namespace
}  // namespace gatelight::neural::testing

// Pictures that are stopped and resumed, and caches that are saved and loaded.

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <functional>

#include "base/errors.h"
#include "base/file/atomic_file.h"
#include "base/simd/isa.h"
#include "renderer/render.h"
#include "tests/renderer/image/kinds_of_pictures.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/messages.h"
#include "tests/support/room.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {

namespace {

using kinds::expect_same;
using kinds::kKinds;
using kinds::picture_of;
using kinds::Result;
using kinds::result_of;
using testing::room;
using tests::expect_message;
using tests::expect_refusal;
using tests::FileSizeLimit;
using tests::read_file;
using tests::refusal;
using tests::TemporaryFolder;

TEST(FullDisk, WithoutACallbackItEndsTheRun) {
  const scene::Scene s = room();
  RenderOptions options = testing::small_picture();
  const TemporaryFolder folder;
  options.checkpoint.file = folder / "picture";
  const FileSizeLimit limit(512);
  std::atomic<bool> reported{false};
  Callbacks callbacks;
  EXPECT_THROW(Renderer(s, options).render(callbacks), OutputError);
  callbacks.output_failed = [&](const std::exception_ptr&, bool) { reported = true; };
  EXPECT_NO_THROW(Renderer(s, options).render(callbacks));
  EXPECT_TRUE(reported);
}

using Resume = kinds::Kinds;

TEST_P(Resume, AResumedPictureHasTheBitsOfAnUninterruptedOne) {
  const scene::Scene s = room();
  RenderOptions options = picture_of(GetParam().integrator);
  GetParam().change(options);
  options.threads = 2;
  const Result straight = result_of(s, options);
  EXPECT_FALSE(straight.statistics.interrupted);
  const bool trains = uses_cache(options.integrator);
  for (const int first_stop : {1, trains ? 2 : 4, trains ? 4 : 5, trains ? 5 : 7}) {
    SCOPED_TRACE(first_stop);
    const TemporaryFolder folder;
    options.checkpoint.file = folder / "picture";
    options.checkpoint.resume = true;
    options.checkpoint.every_seconds = first_stop == 1 ? 0.0 : 60.0;
    // Later and later stops, each with another number of threads.
    int runs = 0;
    Result result;
    for (int stop = first_stop; runs < 20; ++runs, stop = stop * 2 + 1) {
      options.threads = 1 + runs % 3;
      result = result_of(s, options, stop);
      EXPECT_EQ(folder.count_files(), 1u);
      if (!result.statistics.interrupted) break;
      EXPECT_LE(result.statistics.spp, options.spp);
    }
    EXPECT_GT(runs, 0) << "it was never stopped";
    EXPECT_LT(runs, 20);
    expect_same(result, straight);
    EXPECT_GT(result.statistics.render_seconds, 0.0);
  }
}

TEST_P(Resume, MoreSamplesContinueThePicture) {
  const scene::Scene s = room();
  const TemporaryFolder folder;
  RenderOptions options = picture_of(GetParam().integrator);
  GetParam().change(options);
  const Result straight = result_of(s, options);
  options.checkpoint.file = folder / "picture";
  options.checkpoint.resume = true;
  options.spp = 2;
  result_of(s, options);
  options.spp = 5;
  const Result more = result_of(s, options);
  expect_same(more, straight);
  // Nothing is left to do.
  expect_same(result_of(s, options), straight);
  options.spp = 4;
  expect_refusal<CacheFileError>([&] { result_of(s, options); }, {"spp", "5", "4"});
}

INSTANTIATE_TEST_SUITE_P(Kinds, Resume, ::testing::ValuesIn(kKinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(Checkpoints, AMissingFileStartsAnewAndWithoutResumeAnOldOneIsNotRead) {
  const scene::Scene s = room();
  const TemporaryFolder folder;
  RenderOptions options = picture_of(Integrator::path);
  const Result straight = result_of(s, options);
  options.checkpoint.file = folder / "picture";
  options.checkpoint.resume = true;
  expect_same(result_of(s, options), straight);
  const std::string bytes = read_file(options.checkpoint.file);
  EXPECT_FALSE(bytes.empty());
  options.checkpoint.resume = false;
  options.seed = 1;
  EXPECT_EQ(result_of(s, options).statistics.spp, 5);
  EXPECT_NE(read_file(options.checkpoint.file), bytes);
  folder.write("picture", "garbage");
  result_of(s, options);
  options.checkpoint.resume = true;
  expect_same(result_of(s, options), result_of(s, options));
}

TEST(Checkpoints, OptionsThatDecideBitsMustBeTheSame) {
  scene::Scene s = room();
  const TemporaryFolder folder;
  RenderOptions options = picture_of(Integrator::nrc);
  options.checkpoint.file = folder / "picture";
  options.checkpoint.resume = true;
  result_of(s, options, 3);
  const auto resuming = [&](const std::function<void(RenderOptions&)>& change) {
    RenderOptions other = options;
    change(other);
    return refusal<CacheFileError>([&] { result_of(s, other); });
  };
  expect_message(resuming([](RenderOptions& o) { o.seed = 7; }), {"/picture", "seed", "0", "7"});
  expect_message(resuming([](RenderOptions& o) { o.camera.look_at->eye.x() = 0.6f; }), {"camera", "0.6"});
  expect_message(resuming([](RenderOptions& o) { o.environment.constant.x() = 1.0f; }), {"environment"});
  if (simd::available_isas().size() > 1) {
    tests::expect_message(resuming([](RenderOptions& o) { o.isa = "scalar"; }),
                          {"/picture", "kernels", "scalar"});
  }
  s.materials[0].base_color.x() = 0.1f;
  expect_refusal<CacheFileError>([&] { result_of(s, options); }, {"materials"});
  s = room();
  std::string bytes = read_file(options.checkpoint.file);
  bytes[bytes.size() - 9] ^= 1;
  folder.write("picture", bytes);
  expect_refusal<CacheFileError>([&] { result_of(s, options); }, {"/picture"});
  options.checkpoint.file = (folder / "none" / "picture").string();
  EXPECT_THROW(result_of(s, options), OutputError);
}

TEST(Checkpoints, GroupsOfLightsMustBeTheSame) {
  scene::Scene s = room();
  s.materials[1].name = "lamp";
  s.lights = {{.name = "bulb", .position = Vec3(0, 2, 1)}, {.name = "bulb", .position = Vec3(1, 2, 1)}};
  const TemporaryFolder folder;
  RenderOptions options = picture_of(Integrator::path);
  options.light_groups = {{"key", {"lamp", "bulb"}}};
  options.checkpoint.file = folder / "picture";
  options.checkpoint.resume = true;
  result_of(s, options);
  options.light_groups = {{"key", {"lamp"}}, {"fill", {"bulb"}}};
  expect_refusal<CacheFileError>([&] { result_of(s, options); },
                                 {"light-groups", "key=lamp,bulb", "key=lamp;fill=bulb"});
  options.light_groups = {{"key", {"lamp", "bulb"}}};
  s.lights[1].name = "other";
  expect_refusal<CacheFileError>([&] { result_of(s, options); }, {"lights-of-groups"});
}

TEST(CacheFiles, ASavedCacheAnswersAndContinuesTrainingToTheBit) {
  const scene::Scene s = room();
  for (const Integrator integrator : {Integrator::nao, Integrator::nrc}) {
    const TemporaryFolder folder;
    RenderOptions options = picture_of(integrator);
    const Result straight = result_of(s, options);
    options.cache.cache_out = folder / "eight";
    result_of(s, options);
    options.cache.cache_in = options.cache.cache_out;
    options.cache.cache_out = folder / "more";

    options.cache.train_steps = std::nullopt;
    const Result loaded = result_of(s, options);
    EXPECT_EQ(loaded.picture.layers[0].values, straight.picture.layers[0].values);
    EXPECT_EQ(loaded.statistics.cache.steps, 0);
    EXPECT_EQ(loaded.statistics.cache.steps_wanted, 0);
    EXPECT_EQ(read_file(folder / "more"), read_file(folder / "eight"));

    options.cache.train_steps = 8;
    const Result more = result_of(s, options);
    EXPECT_EQ(more.statistics.cache.steps, 8);
    RenderOptions whole = picture_of(integrator);
    whole.cache.train_steps = 16;
    const Result sixteen = result_of(s, whole);
    EXPECT_EQ(more.picture.layers[0].values, sixteen.picture.layers[0].values);
    EXPECT_NE(more.picture.layers[0].values, straight.picture.layers[0].values);

    // Another camera, another size, and other options of training.
    options.camera.look_at->eye = Vec3(-0.5f, 1.0f, 4.0f);
    options.width = 20;
    options.cache.batch = 500;
    options.cache.training.adam.learning_rate = 1e-3f;
    EXPECT_EQ(result_of(s, options).statistics.cache.steps, 8);
  }
}

TEST(CacheFiles, ACheckpointContinuesWithALoadedCache) {
  const scene::Scene s = room();
  const TemporaryFolder folder;
  RenderOptions options = picture_of(Integrator::nrc);
  options.cache.cache_out = folder / "eight";
  result_of(s, options);
  options.cache.cache_in = options.cache.cache_out;
  options.cache.cache_out = folder / "more";
  options.cache.train_steps = 24;  // groups of 8, 16
  const Result straight = result_of(s, options);
  const std::string saved = read_file(folder / "more");
  for (const int stop : {1, 2, 4}) {
    options.checkpoint.file = folder / "picture";
    options.checkpoint.resume = true;
    std::filesystem::remove(folder / "picture");
    std::filesystem::remove(folder / "more");
    EXPECT_TRUE(result_of(s, options, stop).statistics.interrupted);
    EXPECT_EQ(std::filesystem::exists(folder / "more"), stop >= 2) << "a partly trained cache was saved";
    std::filesystem::rename(folder / "eight", folder / "away");
    expect_same(result_of(s, options), straight);
    std::filesystem::rename(folder / "away", folder / "eight");
    EXPECT_EQ(read_file(folder / "more"), saved);
  }
}

}  // namespace
}  // namespace gatelight::renderer

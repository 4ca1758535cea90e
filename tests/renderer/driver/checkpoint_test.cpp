#include "renderer/driver/checkpoint.h"

#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/cached_state.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {

using testing::any_cache_state;
using testing::small_model;
using tests::expect_message;
using tests::expect_refusal;
using tests::refusal;
using tests::TemporaryFolder;

CheckpointIdentity identity() {
  return {{{"seed", "1"}, {"size", "3x2"}},
          {{"geometry", "a1"},
           {"attributes", "b2"},
           {"materials", "c3"},
           {"lights", "d4"},
           {"environment", "e5"}},
          5};
}

Film blank_film(bool with_first_hits) {
  if (!with_first_hits) return {{1, 1, 4, 3}, 8, 8, {}};
  return {{1, 1, 4, 3},
          8,
          8,
          {.aovs = {Aov::depth, Aov::cache_error, Aov::cache_radiance},
           .half = true,
           .guides = true,
           .alpha = true,
           .parts = {"a", "rest"}}};
}

/// Adds another sample to each pixel, with some of everything.
void add_sample(Film& film, std::uint64_t seed) {
  std::uint64_t i = seed << 32;
  const auto next = [&] { return 1e-3f + static_cast<float>(mix_bits(++i) >> 40) * 1e-7f; };
  for (int y = 1; y < 3; ++y) {
    for (int x = 1; x < 4; ++x) {
      film.add(film.take({x, y}), Color(next(), next(), next()));
      if (!film.needs_first_hits()) continue;
      film.add_parts({x, y}, std::vector{Color(next(), next(), next()), Color(next(), next(), next())}, 1.0f);
      FirstHit hit;
      hit.hit = x != 2;
      hit.queried = hit.guided = y != 2;
      hit.guide = {hit.hit, 0, Color::Ones(), Color(next(), next(), next()), Vec3(next(), next(), next())};
      hit.alpha = next();
      for (Color* color : {&hit.albedo, &hit.answer, &hit.node, &hit.cache_radiance})
        *color = Color(next(), next(), next());
      for (Vec3* vector : {&hit.normal, &hit.position}) *vector = Vec3(next(), next(), next());
      for (float* value : {&hit.depth, &hit.error}) *value = next();
      hit.instance = static_cast<decltype(hit.instance)>(x);
      hit.primitive = static_cast<decltype(hit.primitive)>(y);
      hit.training_count = static_cast<decltype(hit.training_count)>(x);
      hit.resolution = static_cast<decltype(hit.resolution)>(y);
      film.add(film.take({x, y}), hit);
    }
  }
}

Bytes bytes_of(const Film& film) {
  Packer packer;
  FilmSums::each_plane(film.sums(),
                       [&](const char*, const auto& plane) { packer.add_all(std::span(plane)); });
  return packer.take();
}

TEST(Checkpoint, FilmAndStatisticsComeBack) {
  const TemporaryFolder folder;
  RenderStatistics statistics;
  statistics.render_seconds = 0.1;
  statistics.rays = {1, 2, ~std::uint64_t{0}, 1e-300};
  statistics.nonfinite = 2;
  statistics.nonfinite_samples = {{3, 4, 5, 6}, {7, 8, 9, 10}};
  statistics.clamped = 11;
  statistics.cache.steps = 12;
  statistics.cache.loss = std::numeric_limits<double>::infinity();
  statistics.cache.train_step_seconds = 13.5;
  statistics.cache.unstored_hits = 14;
  for (const bool first_hits : {false, true}) {
    Film film = blank_film(first_hits);
    add_sample(film, 1);
    write_checkpoint(folder / "a", identity(), {Phase::render, 17}, statistics, film, {});
    Checkpoint checkpoint(folder / "a");
    EXPECT_EQ(checkpoint.progress().phase, Phase::render);
    EXPECT_EQ(checkpoint.progress().samples, 17);
    EXPECT_FALSE(checkpoint.has_cache());
    expect_refusal<CacheFileError>([&] { checkpoint.cache_setup(); }, {"cache"});
    checkpoint.expect(identity(), 17);
    Film restored = blank_film(first_hits);
    RenderStatistics back;
    back.threads = 5;
    checkpoint.restore(restored, back);
    EXPECT_EQ(bytes_of(restored), bytes_of(film));
    EXPECT_EQ(back.render_seconds, 0.1);
    EXPECT_EQ(back.rays.camera, 1u);
    EXPECT_EQ(back.rays.bounce, 2u);
    EXPECT_EQ(back.rays.shadow, ~std::uint64_t{0});
    EXPECT_EQ(back.rays.seconds, 1e-300);
    EXPECT_EQ(back.nonfinite, 2u);
    ASSERT_EQ(back.nonfinite_samples.size(), 2u);
    EXPECT_EQ(back.nonfinite_samples[1].y, 8);
    EXPECT_EQ(back.nonfinite_samples[1].seed, 10u);
    EXPECT_EQ(back.clamped, 11u);
    EXPECT_EQ(back.cache.steps, 12);
    EXPECT_EQ(back.cache.loss, std::numeric_limits<double>::infinity());
    EXPECT_EQ(back.cache.train_step_seconds, 13.5);
    EXPECT_EQ(back.cache.unstored_hits, 14u);
    EXPECT_EQ(back.spp, 17);
    EXPECT_EQ(back.threads, 5);
  }
}

const TrainingGuard kGuard = {0.1, std::numeric_limits<double>::infinity(), 1000, 0.3, 4, 2.5, 900};

TEST(Checkpoint, DifferencesAreRefusedByName) {
  const TemporaryFolder folder;
  Film film = blank_film(false);
  add_sample(film, 1);
  write_checkpoint(folder / "a", identity(), {Phase::render, 17}, {}, film, {});
  Checkpoint checkpoint(folder / "a");
  CheckpointIdentity other = identity();
  other.scene[2].text = other.scene[3].text = "other";
  expect_refusal<CacheFileError>([&] { checkpoint.expect(other, 64); }, {"materials", "lights"});
  expect_refusal<CacheFileError>([&] { checkpoint.expect(identity(), 16); }, {"spp", "17", "16"});
  EXPECT_EQ(refusal<CacheFileError>([&] { checkpoint.expect(identity(), 17); }), "");
  EXPECT_EQ(refusal<CacheFileError>([&] { checkpoint.expect(identity(), 1000); }), "")
      << "more samples continue the picture";
  Film other_film({0, 0, 1, 1}, 8, 8, {});
  RenderStatistics statistics;
  expect_refusal<CacheFileError>([&] { checkpoint.restore(other_film, statistics); },
                                 {"film.radiance", "U32 [84]", "U32 [14]"});
  write_safetensors(folder / "b", {}, {{"format", "gatelight-cache"}});
  expect_refusal<CacheFileError>([&] { Checkpoint(folder / "b"); },
                                 {"format", "gatelight-cache", "gatelight-checkpoint"});
}

// The digest of the file is right.
TEST(Checkpoint, NonFiniteSumsAreRefused) {
  const TemporaryFolder folder;
  const auto expect_refused = [&](Film film, const FilmSums& sums, const tests::NameList& names) {
    film.set_sums(sums);
    write_checkpoint(folder / "a", identity(), {Phase::render, 1}, {}, film, {});
    Checkpoint checkpoint(folder / "a");
    RenderStatistics statistics;
    expect_refusal<CacheFileError>([&] { checkpoint.restore(film, statistics); }, names);
  };
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    FilmSums sums = blank_film(false).sums();
    sums.radiance[2].square[1] = value;
    expect_refused(blank_film(false), sums, {"film.radiance", "2"});
    sums = blank_film(true).sums();
    sums.parts[5][2] = value;
    expect_refused(blank_film(true), sums, {"film.parts", "5"});
  }
}

TEST(Checkpoint, AnImpossibleTrainingGuardIsRefused) {
  const TemporaryFolder folder;
  const auto model = small_model();
  const neural::TrainingOptions options;
  const auto reading = [&](TrainingGuard guard) {
    CacheState state = any_cache_state(*model, options, 1);
    state.steps = 1000;
    state.guard = guard;
    write_checkpoint(folder / "a", identity(), {Phase::train, 0}, {}, blank_film(false),
                     CheckpointCache{state, *model, options});
    return refusal<CacheFileError>([&] { Checkpoint(folder / "a").read_cache(*model, options); });
  };
  EXPECT_EQ(reading(kGuard), "");
  expect_message(reading({.loss_average = NAN}), {"training_guard", "0", "nan"});
  expect_message(reading({.good_steps = 1001}), {"training_guard", "6", "1001", "1000"});
}

}  // namespace
}  // namespace gatelight::renderer

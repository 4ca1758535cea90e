// The starts of training paths: in the picture, on surfaces, with keys that only the step changes.

#include "renderer/cache/training_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "renderer/cache/scene_layout.h"
#include "renderer/film/film_samples.h"
#include "tests/renderer/cache/small_worlds.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;
using testing::ViewedWorld;

constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// A camera at the origin, looking along -z.
scene::Camera training_view() {
  return testing::view_from(Vec3::Zero(), Vec3(0, 0, -1));
}

/// Two walls before the camera: the left half of the picture and the right one.
SceneBuilder two_walls() {
  SceneBuilder builder;
  const int matte = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  builder.quad(matte, Vec3(-9, -9, -2), Vec3(9, 0, 0), Vec3(0, 18, 0));
  builder.quad(matte, Vec3(0, -9, -2), Vec3(9, 0, 0), Vec3(0, 18, 0));
  builder.scene().cameras.push_back(training_view());
  return builder;
}

TrainingStarts choose(const ViewedWorld& walls, const RenderOptions& options, std::uint64_t step,
                      std::size_t count, PixelRect region = {0, 0, kWidth, kHeight}, bool need_hits = false,
                      std::uint64_t* traced = nullptr) {
  const std::vector<neural::Sides> sides(2, neural::Sides::front);
  const TrainingPoints points(walls.world, walls.camera, region, options, sides, nullptr);
  TrainingStarts result;
  RayCounts rays;
  points.choose(step, count, need_hits, {}, result, rays);
  if (traced) *traced = rays.camera;
  return result;
}

/// The position where the ray passes the picture, in pixels.
std::array<double, 2> film_position(const Ray& ray) {
  const double half = std::tan(0.5 * static_cast<double>(training_view().vertical_fov));
  const Eigen::Vector3d d = ray.direction.cast<double>() / -static_cast<double>(ray.direction.z());
  return {(d.x() / (half * kWidth / kHeight) + 1.0) * 0.5 * kWidth, (1.0 - d.y() / half) * 0.5 * kHeight};
}

std::vector<std::uint32_t> bits_of(const TrainingStarts& starts) {
  std::vector<std::uint32_t> bits;
  for (const PathStart& s : starts.starts) {
    const Ray& ray = s.sample.camera_ray.ray;
    for (int axis = 0; axis < 3; ++axis) {
      bits.push_back(std::bit_cast<std::uint32_t>(ray.origin[axis]));
      bits.push_back(std::bit_cast<std::uint32_t>(ray.direction[axis]));
    }
    bits.push_back(s.sample.seed);
    bits.push_back(s.to_its_end ? 1u : 0u);
    bits.push_back(std::bit_cast<std::uint32_t>(s.sample.sampler.get_1d(3)));
  }
  for (const Hit& h : starts.hits) {
    bits.insert(bits.end(), {h.instance, h.primitive, std::bit_cast<std::uint32_t>(h.t),
                             std::bit_cast<std::uint32_t>(h.u), std::bit_cast<std::uint32_t>(h.v)});
  }
  for (const std::size_t offset : starts.offsets) bits.push_back(static_cast<std::uint32_t>(offset));
  return bits;
}

void expect_blocks_cover(const TrainingStarts& starts) {
  ASSERT_FALSE(starts.offsets.empty());
  EXPECT_EQ(starts.offsets.front(), 0u);
  EXPECT_EQ(starts.offsets.back(), starts.starts.size());
  EXPECT_TRUE(std::is_sorted(starts.offsets.begin(), starts.offsets.end()));
}

TEST(TrainingPoints, EachCellOfTheRegionHasOnePoint) {
  const ViewedWorld walls(two_walls());
  const RenderOptions options;
  const PixelRect region{8, 4, 40, 28};  // 32 x 24: 16 x 12 cells of 2 x 2 pixels
  for (std::uint64_t step = 0; step < 3; ++step) {
    const TrainingStarts starts = choose(walls, options, step, 192, region);
    ASSERT_EQ(starts.starts.size(), 192u);
    EXPECT_TRUE(starts.hits.empty());
    expect_blocks_cover(starts);
    std::vector<int> cells(192, 0);
    double offset = 0.0;
    for (const PathStart& s : starts.starts) {
      const auto [x, y] = film_position(s.sample.camera_ray.ray);
      ASSERT_TRUE(x >= 8 && x < 40 && y >= 4 && y < 28) << x << ", " << y;
      const auto column = static_cast<std::size_t>((x - 8) / 2);
      const auto row = static_cast<std::size_t>((y - 4) / 2);
      ++cells[16 * row + column];
      offset += std::fmod(x, 2.0) / 2.0 - 0.5;
    }
    EXPECT_EQ(std::count(cells.begin(), cells.end(), 1), 192);
    EXPECT_NE(offset, 0.0) << "jittered";
  }
}

TEST(TrainingPoints, SamplesOfThePictureAreThoseThatItsPassesWouldTakeNext) {
  const ViewedWorld walls(two_walls());
  RenderOptions options;
  options.seed = 5;
  const PixelRect region{8, 4, 40, 28};
  const std::vector<neural::Sides> sides(2, neural::Sides::front);
  const TrainingPoints points(walls.world, walls.camera, region, options, sides, nullptr);
  const FilterSampler filter(options.filter, options.filter_width);
  Film film(region, kWidth, kHeight, {});
  TrainingStarts starts;
  RayCounts rays;
  std::uint64_t first = 0;
  for (const std::size_t count : {1u, 300u, 1500u, 503u}) {  // three rounds of 768 in all
    points.choose(7, count, false, {}, starts, rays, first);
    first += count;
    expect_blocks_cover(starts);
    ASSERT_EQ(starts.starts.size(), count);
    ASSERT_EQ(starts.samples.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      const PixelSample next = film.take(starts.samples[i].pixel);
      EXPECT_EQ(starts.samples[i].number, next.number);
      const CameraSample expected = make_camera_sample(next, options, walls.camera, filter);
      EXPECT_EQ(starts.starts[i].sample.seed, expected.seed);
      EXPECT_EQ(starts.starts[i].sample.camera_ray.ray.direction, expected.camera_ray.ray.direction);
    }
    // Samples of a pixel are added in turn, by one thread.
    for (std::size_t b = 1; b + 1 < starts.offsets.size(); ++b) {
      const Pixel before = starts.samples[starts.offsets[b] - 1].pixel,
                  after = starts.samples[starts.offsets[b]].pixel;
      EXPECT_FALSE(before.x == after.x && before.y == after.y);
    }
  }
  for (int y = region.y0; y < region.y1; ++y) {
    for (int x = region.x0; x < region.x1; ++x) EXPECT_EQ(film.taken({x, y}), 3u);
  }
  points.choose(7, 100, false, {}, starts, rays);
  EXPECT_TRUE(starts.samples.empty()) << "without a first sample the points are no samples";
}

TEST(TrainingPoints, CountsThatFillNoGridAreNearlyKept) {
  const ViewedWorld walls(two_walls());
  const RenderOptions options;
  for (const std::size_t count : {1u, 2u, 7u, 100u, 1000u, 5297u}) {
    const auto made = static_cast<double>(choose(walls, options, 0, count).starts.size());
    EXPECT_NEAR(made, static_cast<double>(count), 0.5 * std::sqrt(static_cast<double>(count)) + 1.0);
  }
  // A region of one pixel in height.
  EXPECT_EQ(choose(walls, options, 0, 50, {0, 7, 64, 8}).starts.size(), 50u);
  EXPECT_NEAR(static_cast<double>(choose(walls, options, 0, 50, {7, 0, 8, 48}).starts.size()), 50.0, 1.0);
}

TEST(TrainingPoints, EqualStepsAreEqualAndOthersAreNot) {
  const ViewedWorld walls(two_walls());
  for (const TrainingSource source : {TrainingSource::camera, TrainingSource::surface}) {
    RenderOptions options;
    options.cache.source = source;
    const std::vector<std::uint32_t> first = bits_of(choose(walls, options, 3, 64));
    EXPECT_EQ(bits_of(choose(walls, options, 3, 64)), first);
    std::set<std::uint32_t> seeds;
    std::size_t made = 0;
    for (const std::uint64_t step : {std::uint64_t{3}, std::uint64_t{4}, (std::uint64_t{1} << 32) + 3}) {
      const TrainingStarts starts = choose(walls, options, step, 64);
      if (step != 3) {
        EXPECT_NE(bits_of(starts), first);
      }
      for (const PathStart& s : starts.starts) seeds.insert(s.sample.seed);
      made += starts.starts.size();
    }
    EXPECT_EQ(seeds.size(), made) << "each start of each step has a seed of its own";
    options.seed = 1;
    EXPECT_NE(bits_of(choose(walls, options, 3, 64)), first);
  }
}

TEST(TrainingPoints, HitsAreTracedOnRequest) {
  const ViewedWorld walls(two_walls());
  const RenderOptions options;
  std::uint64_t traced = 0;
  const TrainingStarts starts = choose(walls, options, 0, 300, {0, 0, kWidth, kHeight}, true, &traced);
  ASSERT_EQ(starts.hits.size(), starts.starts.size());
  EXPECT_EQ(traced, starts.starts.size());
  for (std::size_t i = 0; i < starts.hits.size(); ++i) {
    const Ray& ray = starts.starts[i].sample.camera_ray.ray;
    const Vec3 p = ray.origin + starts.hits[i].t * ray.direction;
    EXPECT_NEAR(p.z(), -2.0f, 1e-5f);
    EXPECT_EQ(starts.hits[i].instance, p.x() < 0.0f ? 0u : 1u);
  }
  choose(walls, options, 0, 300, {0, 0, kWidth, kHeight}, false, &traced);
  EXPECT_EQ(traced, 0u);
}

TEST(TrainingPoints, SamplesOfAPointAreConsecutiveWithKeysOfTheirOwn) {
  const ViewedWorld walls(two_walls());
  for (const TrainingSource source : {TrainingSource::camera, TrainingSource::surface}) {
    RenderOptions options;
    options.cache.source = source;
    const TrainingStarts once = choose(walls, options, 2, 300, {0, 0, kWidth, kHeight}, true);
    options.cache.samples_per_point = 4;
    const TrainingStarts starts = choose(walls, options, 2, 300);
    ASSERT_EQ(starts.starts.size(), 4 * once.starts.size());
    ASSERT_EQ(starts.hits.size(), starts.starts.size());
    expect_blocks_cover(starts);
    for (const std::size_t offset : starts.offsets) EXPECT_EQ(offset % 4, 0u);
    std::set<std::uint32_t> seeds;
    for (std::size_t i = 0; i < starts.starts.size(); ++i) {
      const Ray& ray = starts.starts[i].sample.camera_ray.ray;
      const Ray& expected = once.starts[i / 4].sample.camera_ray.ray;
      ASSERT_EQ(ray.origin, expected.origin);
      ASSERT_EQ(ray.direction, expected.direction);
      ASSERT_EQ(starts.hits[i].primitive, once.hits[i / 4].primitive);
      ASSERT_EQ(starts.hits[i].u, once.hits[i / 4].u);
      seeds.insert(starts.starts[i].sample.seed);
    }
    EXPECT_EQ(seeds.size(), starts.starts.size());
  }
}

TEST(TrainingPoints, SurfacePointsLieOnTheirRays) {
  SceneBuilder builder;
  const int matte = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  builder.quad(matte, Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 0.5f, -1));
  builder.mesh(matte, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  scene::Instance& mirrored = builder.scene().instances[1];
  mirrored.baked = false;
  mirrored.swaps_handedness = true;
  mirrored.transform.translate(Vec3(10, 0, 0));
  mirrored.transform.scale(Vec3(-1, 2, 1));
  builder.scene().cameras.push_back(training_view());
  const ViewedWorld viewed(builder);
  RenderOptions options;
  options.cache.source = TrainingSource::surface;
  const std::vector<neural::Sides> sides{neural::Sides::both, neural::Sides::back};
  const TrainingPoints points(viewed.world, viewed.camera, viewed.region, options, sides, nullptr);
  TrainingStarts starts;
  RayCounts rays;
  points.choose(0, 500, false, {}, starts, rays);
  ASSERT_EQ(starts.starts.size(), 500u);
  ASSERT_EQ(starts.hits.size(), 500u);
  EXPECT_EQ(rays.camera, 0u) << "their hits are known";
  std::size_t mirrored_points = 0;
  for (std::size_t i = 0; i < 500; ++i) {
    const Ray& ray = starts.starts[i].sample.camera_ray.ray;
    const Hit& hit = starts.hits[i];
    ASSERT_NEAR(ray.direction.norm(), 1.0f, 1e-5f);
    const Surface surface = viewed.world.surfaces.at(hit, ray.direction, 0.0f, 0.5f);
    const Vec3 p = ray.origin + hit.t * ray.direction;
    ASSERT_LT((p - surface.position).norm(), 1e-5f * (1.0f + p.norm()));
    Hit met;
    viewed.world.accel.intersect(std::span(&ray, 1), std::span(&met, 1), false);
    ASSERT_EQ(met.instance, hit.instance);
    ASSERT_EQ(met.primitive, hit.primitive);
    // The side of the hit has storage.
    const bool mirrors = hit.instance == 1;
    EXPECT_TRUE(has_side(sides[hit.instance], side_of(surface.front, mirrors)));
    mirrored_points += mirrors ? 1 : 0;
  }
  EXPECT_GT(mirrored_points, 50u);
}

TEST(TrainingPoints, WithoutAnySurfaceTheCameraIsTheSource) {
  const ViewedWorld walls(two_walls());
  RenderOptions options;
  options.cache.source = TrainingSource::surface;
  const std::vector<neural::Sides> none(2, neural::Sides::none);
  const TrainingPoints points(walls.world, walls.camera, {0, 0, kWidth, kHeight}, options, none, nullptr);
  TrainingStarts starts;
  RayCounts rays;
  points.choose(0, 64, false, {}, starts, rays);
  EXPECT_GT(starts.starts.size(), 50u);
  EXPECT_TRUE(starts.hits.empty());
}

}  // namespace
}  // namespace gatelight::renderer

#include "renderer/cache/training_points.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/parallel/loops.h"
#include "neural/learning/training_counts.h"
#include "renderer/cache/scene_layout.h"
#include "renderer/film/film_samples.h"
#include "renderer/film/tiles.h"
#include "renderer/sampling/warp.h"
#include "scene/triangle_normal.h"

namespace gatelight::renderer {
namespace {

/// Indices of a range of cheap work.
constexpr std::size_t kStartsOfRange = 256;

/// Starts of a block, which one thread traces: those of a tile of the picture, or fewer where many threads
/// would have none.
std::size_t block_size(std::size_t count) {
  constexpr std::size_t kMax = kTile * kTile, kFewest = 64, kBlocks = 64;
  return std::clamp((count / kBlocks + 15) / 16 * 16, kFewest, kMax);
}

// Sampler dimensions of a start, beyond those of its path.
constexpr std::uint32_t kSurfaceChoice = 0xffff0000u;
constexpr std::uint32_t kSurfacePoint = kSurfaceChoice + 1;
constexpr std::uint32_t kSurfaceDirection = kSurfaceChoice + 2;
constexpr std::uint32_t kCandidateChoice = kSurfaceChoice + 3;

std::uint32_t step_seed(const RenderOptions& options, std::uint64_t step) {
  const std::uint32_t seed = hash(hash(options.seed ^ 0x7a3f19c5u) + static_cast<std::uint32_t>(step));
  return hash(seed + static_cast<std::uint32_t>(step >> 32));
}

/// Whether start `index` belongs to the fraction that run to their end. They are evenly spread, with another
/// offset in each step.
bool runs_to_its_end(std::size_t index, float fraction, std::uint32_t seed) {
  const double offset = static_cast<double>(sampling::to_unit_float(hash(seed ^ 0x3c6ef372u)));
  const double f = static_cast<double>(fraction);
  return std::floor(static_cast<double>(index + 1) * f + offset) >
         std::floor(static_cast<double>(index) * f + offset);
}

/// Seeds a start; samples are stratified over the step.
void key(const RenderOptions& options, std::uint32_t seed, std::size_t index, PathStart& start) {
  const auto number = static_cast<std::uint32_t>(index);
  start.sample.sampler = Sampler(options.sampler, seed, 0, 0, number);
  start.sample.seed = hash(hash(seed) + number);
  start.to_its_end = runs_to_its_end(index, options.cache.self_training.full_fraction, seed);
}

struct KeyedPlace {
  std::uint32_t morton;
  PixelSample place;
};

/// A stable radix sort. For the tens of thousands of places of a group it takes a tenth of a sort by
/// comparison, which threads would have to share.
void sort_by_morton(std::vector<KeyedPlace>& places) {
  constexpr std::uint32_t kBits = 11;
  std::uint32_t all = 0;
  for (const KeyedPlace& p : places) all |= p.morton;
  std::vector<KeyedPlace> sorted(places.size());
  for (std::uint32_t shift = 0; shift < 32 && all >> shift != 0; shift += kBits) {
    const auto digit = [shift](const KeyedPlace& p) { return p.morton >> shift & ((1u << kBits) - 1); };
    std::array<std::uint32_t, (1u << kBits) + 1> next{};
    for (const KeyedPlace& p : places) ++next[digit(p) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (const KeyedPlace& p : places) sorted[next[digit(p)]++] = p;
    places.swap(sorted);
  }
}

}  // namespace

TrainingPoints::TrainingPoints(const World& world, const Camera& camera, const PixelRect& region,
                               const RenderOptions& options, std::span<const neural::Sides> sides,
                               const neural::GateLayout* layout)
    : world_(world),
      camera_(camera),
      region_(region),
      options_(options),
      filter_(options.filter, options.filter_width),
      order_(region),
      layout_(layout) {
  if (options.cache.source != TrainingSource::surface) return;
  const scene::Scene& scene = world.scene;
  std::vector<double> areas;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const auto instance_sides = static_cast<std::uint8_t>(sides[i]);
    if (instance_sides == 0) continue;
    const double both = sides[i] == neural::Sides::both ? 2.0 : 1.0;
    const auto count = static_cast<std::uint32_t>(scene.mesh_of(scene.instances[i]).triangles.size());
    for (std::uint32_t t = 0; t < count; ++t) {
      const double area = scene::world_area(scene, scene.instances[i], t);
      if (!(area > 0.0) || !std::isfinite(area)) continue;
      triangles_.push_back({i, t, instance_sides});
      areas.push_back(area * both);
    }
  }
  by_area_ = AliasTable(areas);
  surroundings_.emplace(scene, world.media, world.accel, world.surfaces, scene.bounds);
}

void TrainingPoints::choose(std::uint64_t step, std::size_t count, bool need_hits,
                            std::span<const std::uint32_t> counts, TrainingStarts& result, RayCounts& rays,
                            const std::optional<std::uint64_t>& first_sample) const {
  result.hits.clear();
  result.samples.clear();
  if (first_sample) return from_picture(step, *first_sample, count, result);
  if (options_.cache.source == TrainingSource::surface && !by_area_.empty()) {
    from_surfaces(step, count, result);
  } else {
    from_camera(step, count, result);
    const bool compare = options_.cache.candidates > 1 && !counts.empty();
    if (need_hits || compare || options_.cache.samples_per_point > 1) {
      result.hits.assign(result.starts.size(), {});
      tbb::enumerable_thread_specific<RayCounts> parts;
      for_each(result.blocks(), [&](std::size_t block) { trace(result, block, parts.local()); });
      for (const RayCounts& part : parts) rays.add(part);
    }
  }
  if (options_.cache.candidates > 1 && !counts.empty()) prefer_seldom(step, counts, result);
  if (options_.cache.samples_per_point > 1) repeat(step, result);
}

void TrainingPoints::from_picture(std::uint64_t step, std::uint64_t first, std::size_t count,
                                  TrainingStarts& result) const {
  std::vector<KeyedPlace> places(count);
  for_each_range(count, kStartsOfRange, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const PixelSample place = order_.at(first + i);
      places[i] = {morton(place.pixel), place};
    }
  });
  sort_by_morton(places);  // samples of one pixel keep the order of their numbers
  result.starts.resize(count);
  result.samples.resize(count);
  // Samples of one pixel stay in one block: they are added to the film in order.
  result.offsets.assign(1, 0);
  const std::size_t block = block_size(count);
  for (std::size_t end = 0; end < count;) {
    end = std::min(end + block, count);
    while (end < count && places[end].morton == places[end - 1].morton) ++end;
    result.offsets.push_back(end);
  }
  const std::uint32_t seed = step_seed(options_, step);
  for_each_range(count, kStartsOfRange, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      result.samples[i] = places[i].place;
      result.starts[i] = {make_camera_sample(places[i].place, options_, camera_, filter_),
                          runs_to_its_end(i, options_.cache.self_training.full_fraction, seed)};
    }
  });
}

void TrainingPoints::from_camera(std::uint64_t step, std::size_t count, TrainingStarts& result) const {
  // A grid of about `count` cells over the region, one point in each.
  const double aspect = static_cast<double>(region_.width()) / region_.height();
  const auto nearest = [](double x) { return std::max(1, static_cast<int>(std::lround(x))); };
  const int rows = nearest(std::sqrt(static_cast<double>(count) / aspect));
  const int columns = nearest(static_cast<double>(count) / rows);
  const float cell_width = static_cast<float>(region_.width()) / static_cast<float>(columns);
  const float cell_height = static_cast<float>(region_.height()) / static_cast<float>(rows);
  const TileGrid tiles({0, 0, columns, rows});
  std::vector<std::vector<Pixel>> cells(static_cast<std::size_t>(tiles.count()));
  std::vector<std::size_t> firsts(1, 0);
  result.offsets.assign(1, 0);
  const std::size_t block = block_size(count);
  for (int t = 0; t < tiles.count(); ++t) {
    tiles.pixels(t, cells[static_cast<std::size_t>(t)]);
    firsts.push_back(firsts.back() + cells[static_cast<std::size_t>(t)].size());
    while (result.offsets.back() < firsts.back())
      result.offsets.push_back(std::min(result.offsets.back() + block, firsts.back()));
  }
  result.starts.resize(firsts.back());
  const std::uint32_t seed = step_seed(options_, step);
  for_each(cells.size(), [&](std::size_t t) {
    for (std::size_t i = 0; i < cells[t].size(); ++i) {
      const std::size_t index = firsts[t] + i;
      PathStart& start = result.starts[index];
      key(options_, seed, index, start);
      // Jitter by the pixel's own hash: neighbouring cells would line up in a low-discrepancy sequence.
      const std::uint32_t jitter = hash(start.sample.seed ^ 0x1b873593u);
      const float x = static_cast<float>(cells[t][i].x) + sampling::to_unit_float(jitter);
      const float y = static_cast<float>(cells[t][i].y) + sampling::to_unit_float(hash(jitter));
      start.sample.camera_ray =
          camera_ray(camera_, static_cast<float>(region_.x0) + x * cell_width,
                     static_cast<float>(region_.y0) + y * cell_height, start.sample.sampler);
      start.sample.start = camera_.medium_of(start.sample.camera_ray.ray);
    }
  });
}

void TrainingPoints::from_surfaces(std::uint64_t step, std::size_t count, TrainingStarts& result) const {
  const scene::Scene& scene = world_.scene;
  result.starts.resize(count);
  result.hits.resize(count);
  result.offsets.assign(1, 0);
  const std::size_t block = block_size(count);
  for (std::size_t begin = 0; begin < count; begin += block)
    result.offsets.push_back(std::min(begin + block, count));
  const std::uint32_t seed = step_seed(options_, step);
  for_each_range(count, kStartsOfRange, [&](std::size_t begin, std::size_t end) {
    for (std::size_t index = begin; index < end; ++index) {
      PathStart& start = result.starts[index];
      key(options_, seed, index, start);
      const Sampler& sampler = start.sample.sampler;
      const double u = (static_cast<double>(index) + static_cast<double>(sampler.get_1d(kSurfaceChoice))) /
                       static_cast<double>(count);
      const Triangle& triangle = triangles_[by_area_.sample(std::min(u, 0x1.fffffffffffffp-1))];
      const scene::Instance& instance = scene.instances[triangle.instance];
      const Vec2 point = sample_uniform_triangle(sampler.get_2d(kSurfacePoint));
      const std::array<Vec3, 3> corners = scene::world_triangle(scene, instance, triangle.primitive);
      float twice_area = 0.0f;
      const Vec3 normal = scene::triangle_normal(corners[0], corners[1], corners[2], twice_area);
      const bool back = triangle.sides == 2 || (triangle.sides == 3 && (hash(start.sample.seed) & 1u) != 0);
      const Vec3 wo = Basis(back ? Vec3(-normal) : normal)
                          .to_world(sample_cosine_hemisphere(sampler.get_2d(kSurfaceDirection)));
      Hit& hit = result.hits[index];
      hit = {1.0f, point.x(), point.y(), triangle.instance, triangle.primitive};
      CameraRay& ray = start.sample.camera_ray;
      ray = {};
      ray.ray.origin =
          corners[0] + point.x() * (corners[1] - corners[0]) + point.y() * (corners[2] - corners[0]) + wo;
      ray.ray.direction = -wo;
      const Vec3 off_surface = world_.surfaces.at(hit, -wo, 0.0f, 0.0f).spawn(wo);
      start.sample.start = surroundings_->at(off_surface, ray.ray.time);
    }
  });
}

void TrainingPoints::trace(TrainingStarts& result, std::size_t block, RayCounts& rays) const {
  const std::size_t begin = result.offsets[block];
  const std::size_t size = result.offsets[block + 1] - begin;
  rays.camera += size;
  std::vector<Ray> traced(size);
  for (std::size_t i = 0; i < size; ++i) {
    traced[i] = result.starts[begin + i].sample.camera_ray.ray;
    traced[i].seed = result.starts[begin + i].sample.seed;
  }
  world_.accel.intersect(traced, std::span(result.hits).subspan(begin, size), true);
}

std::uint32_t TrainingPoints::triangle_number(const Hit& hit, const Vec3& direction) const {
  const neural::GateSurface& s = layout_->surfaces[surface_of_hit(world_.scene, hit, direction)];
  return s.triangle_count > 0 ? s.first_triangle + hit.primitive : kNoTriangle;
}

void TrainingPoints::prefer_seldom(std::uint64_t step, std::span<const std::uint32_t> counts,
                                   TrainingStarts& result) const {
  const std::size_t size = result.starts.size();
  const std::uint32_t seed = step_seed(options_, step);
  std::vector<std::uint32_t> numbers(size, kNoTriangle);
  for_each_range(size, kStartsOfRange, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (result.hits[i])
        numbers[i] = triangle_number(result.hits[i], result.starts[i].sample.camera_ray.ray.direction);
    }
  });
  const std::vector<PathStart> pool = result.starts;
  const std::vector<Hit> hits = result.hits;
  const auto most = static_cast<std::size_t>(options_.cache.candidates);
  const auto choose_one = [&](std::size_t i) {
    std::vector<std::uint32_t> candidates;
    std::vector<std::size_t> places;
    std::uint32_t random = hash(hash(seed ^ kCandidateChoice) + static_cast<std::uint32_t>(i));
    for (std::size_t c = 0; c < most; ++c) {
      random = hash(random + 0x9e3779b9u);
      const auto place = static_cast<std::size_t>((std::uint64_t{random} * size) >> 32);
      // A triangle without storage is never counted, so it would always be chosen.
      if (numbers[place] == kNoTriangle) continue;
      candidates.push_back(numbers[place]);
      places.push_back(place);
    }
    if (places.empty()) return;
    const std::size_t chosen =
        neural::choose_candidate(candidates, counts, sampling::to_unit_float(hash(random)));
    result.starts[i].sample.camera_ray = pool[places[chosen]].sample.camera_ray;
    result.starts[i].sample.start = pool[places[chosen]].sample.start;
    result.hits[i] = hits[places[chosen]];
  };
  for_each_range(size, kStartsOfRange, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) choose_one(i);
  });
}

void TrainingPoints::repeat(std::uint64_t step, TrainingStarts& result) const {
  const auto times = static_cast<std::size_t>(options_.cache.samples_per_point);
  const std::uint32_t seed = step_seed(options_, step);
  std::vector<PathStart> starts(result.starts.size() * times);
  std::vector<Hit> hits(starts.size());
  for (std::size_t i = 0; i < starts.size(); ++i) {
    starts[i] = result.starts[i / times];
    key(options_, seed, i, starts[i]);
    hits[i] = result.hits[i / times];
  }
  result.starts = std::move(starts);
  result.hits = std::move(hits);
  for (std::size_t& offset : result.offsets) offset *= times;
}

}  // namespace gatelight::renderer

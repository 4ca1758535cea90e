#include "renderer/cache/scouting.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel/loops.h"
#include "renderer/cache/node_spacing.h"
#include "renderer/cache/radiance_records.h"
#include "renderer/cache/scene_layout.h"

namespace gatelight::renderer {

/// The surfaces that scouting paths hit, and the width of pixels there.
struct Scouted {
  std::vector<std::uint8_t> sides;  ///< bits of the sides of each instance
  PixelWidths widths;
  std::vector<double> luminances;
  double paths = 0.0;
  double records = 0.0;           ///< of all paths
  double records_if_short = 0.0;  ///< if the paths end after the vertices of self-training
  RayCounts rays;

  explicit Scouted(std::size_t instances) : sides(instances, 0), widths(instances) {}
};

namespace {

/// Numbers of paths that are followed to their ends, and of additional camera rays. An object of a thousandth
/// of the picture is missed by the former with a probability of 1e-14.
constexpr std::size_t kPaths = std::size_t{1} << 15;
constexpr std::size_t kCameraRays = std::size_t{1} << 17;
constexpr std::size_t kCameraGroups = 8;
/// Indices of a range of cheap work.
constexpr std::size_t kPointsOfRange = 1024;
/// No training steps have this number and those before it, so scouting has random numbers of its own.
constexpr std::uint64_t kStep = ~std::uint64_t{0};

/// Node spacing over the height of the picture (README.md, "Scene requirements"). Occlusion is sharper than
/// radiance and cheaper to learn.
constexpr float kRadianceSpacing = 0.03f;
constexpr float kOcclusionSpacing = 0.015f;

/// The area of each instance in square metres.
std::vector<double> areas_of(const scene::Scene& scene) {
  std::vector<double> areas(scene.instances.size(), 0.0);
  for_each(areas.size(), [&](std::size_t i) {
    const scene::Instance& instance = scene.instances[i];
    const std::size_t triangles = scene.mesh_of(instance).triangles.size();
    for (std::size_t t = 0; t < triangles; ++t) {
      const double area = scene::world_area(scene, instance, static_cast<std::uint32_t>(t));
      if (std::isfinite(area)) areas[i] += area;
    }
  });
  return areas;
}

/// The number of records of each path.
std::vector<int> records_by_path(const PathBatch& batch) {
  std::vector<int> records(batch.paths(), 0);
  for (const PathVertex& v : batch.vertices) {
    if (v.record != kNone) ++records[v.path];
  }
  return records;
}

/// Mean number of records of a path, from which a step chooses its number of paths. 1 where there are no
/// records at all.
float records_per_path(double records, double paths) {
  return records > 0.0 ? static_cast<float>(std::max(records / paths, double{kMinRecordsPerPath})) : 1.0f;
}

/// Mean of the values, each limited to a hundred times the median of those above zero. One path that hits a
/// tiny lamp in a mirror must not decide the brightness of a scene.
double robust_mean(const std::vector<double>& values) {
  std::vector<double> lit;
  for (const double v : values) {
    if (v > 0.0) lit.push_back(v);
  }
  if (lit.empty()) return 0.0;
  const auto middle = lit.begin() + static_cast<std::ptrdiff_t>(lit.size() / 2);
  std::nth_element(lit.begin(), middle, lit.end());
  const double most = 100.0 * *middle;
  double sum = 0.0;
  for (const double v : values) sum += std::min(v, most);
  return sum / static_cast<double>(values.size());
}

constexpr std::uint32_t kNoSurface = ~0u;

/// A point that a scouting path hit.
struct Sighted {
  std::uint32_t surface = kNoSurface;
  float width = 0.0f;  ///< of a pixel
  float luminance = 0.0f;
};

void mark(std::vector<std::uint8_t>& met, std::uint32_t surface) {
  met[surface / 2] = static_cast<std::uint8_t>(met[surface / 2] | (1u << (surface % 2)));
}

/// The options of scouting: plain paths from camera rays.
RenderOptions plain_options(const RenderOptions& options) {
  RenderOptions plain = options;
  plain.cache.source = TrainingSource::camera;
  plain.cache.candidates = 1;
  plain.cache.samples_per_point = 1;
  return plain;
}

/// Returns the numbers of rays, and of those that hit a surface.
std::pair<double, double> scout_camera_rays(const World& world, const TrainingPoints& points, RayCounts& rays,
                                            Scouted& scouted) {
  TrainingStarts starts;
  double traced = 0.0, hits = 0.0;
  // A group at a time, so that the memory of the starts is used again.
  for (std::size_t group = 0; group < kCameraGroups; ++group) {
    points.choose(kStep - group, kCameraRays / kCameraGroups, true, {}, starts, rays);
    std::vector<Sighted> sighted(starts.starts.size());
    for_each_range(sighted.size(), kPointsOfRange, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Hit& hit = starts.hits[i];
        if (!hit) continue;
        const CameraRay& camera_ray = starts.starts[i].sample.camera_ray;
        sighted[i] = {surface_of_hit(world.scene, hit, camera_ray.ray.direction),
                      camera_ray.cone.width + camera_ray.cone.spread * hit.t};
      }
    });
    for (const Sighted& point : sighted) {
      if (point.surface == kNoSurface) continue;
      mark(scouted.sides, point.surface);
      scouted.widths.add_camera(point.surface / 2, point.width);
      ++hits;
    }
    traced += static_cast<double>(sighted.size());
  }
  return {traced, hits};
}

/// Numbers of records: of all paths, and of paths that end after the vertices of self-training.
struct RecordCounts {
  double all = 0.0;
  double few = 0.0;
};

RecordCounts count_records(const RecordBatch& batch, int vertices, const RecordExchange& exchange) {
  RecordCounts counts;
  for (const PathBatch& block : batch.paths) {
    for (const int n : records_by_path(block)) {
      counts.all += n;
      counts.few += std::min(n, vertices);
    }
  }
  return {exchange.sum(counts.all), exchange.sum(counts.few)};
}

void scout_paths(const World& world, const Camera& camera, const RenderOptions& options,
                 const TrainingPoints& points, RecordExchange& exchange, Scouted& scouted) {
  const RenderOptions plain = plain_options(options);
  const StoredSurfaces everything;
  const CachedPaths paths(world, cached_paths_options(plain), everything);
  PointInputs inputs;
  inputs.positions = true;
  RadianceRecords records(paths, points, plain, inputs);
  RecordBatch batch;
  const RecordRequest request{
      .step = kStep - kCameraGroups, .points = kPaths, .counts_choice = exchange.counts_common_rays()};
  records.begin(request, batch);
  exchange.choose_blocks(batch);
  records.trace(batch);
  records.finish({}, batch);
  exchange.receive(exchange.send(batch, {}), batch);
  records.split(request, batch);
  scouted.rays.add(records.rays());

  const RecordCounts counts = count_records(batch, options.cache.self_training.vertices, exchange);
  const CameraRay eye =
      camera.ray(0.5f * static_cast<float>(options.width), 0.5f * static_cast<float>(options.height));
  std::vector<Sighted> sighted(batch.records.size());
  const neural::QueryBatch met = batch.records.batch();
  for_each_range(sighted.size(), kPointsOfRange, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Map<const Vec3> position(met.positions[i].data());
      const float distance = (position - eye.ray.origin).norm();
      sighted[i] = {met.surfaces[i], eye.cone.width + eye.cone.spread * distance,
                    luminance(Color(Eigen::Map<const Color>(&batch.targets[3 * i])))};
    }
  });
  for (const Sighted& point : sighted) {
    mark(scouted.sides, point.surface);
    if (std::isfinite(point.luminance)) scouted.luminances.push_back(static_cast<double>(point.luminance));
    scouted.widths.add_met(point.surface / 2, point.width);
  }
  scouted.paths += static_cast<double>(batch.paths_traced);
  scouted.records += counts.all;
  scouted.records_if_short += counts.few;
}

/// The sides of an instance that get storage; `hit`: those that scouting paths hit.
neural::Sides stored_sides(const scene::Scene& scene, const scene::Instance& instance, unsigned hit,
                           bool scouted) {
  const auto possible = static_cast<unsigned>(possible_sides(scene, instance));
  if (!scouted) return static_cast<neural::Sides>(possible);
  // A back that materials do not distinguish from the front shares its storage.
  const bool shares = hit != 0 && (hit & possible) == 0;
  return static_cast<neural::Sides>(shares ? possible : hit & possible);
}

void choose_spacing(const scene::Scene& scene, const RenderOptions& options, const Scouted& scouted,
                    CacheSetup& setup) {
  const float of_height = options.integrator == Integrator::nao ? kOcclusionSpacing : kRadianceSpacing;
  NodeSpacing found = scouted.widths.spacing(of_height * static_cast<float>(options.height), areas_of(scene));
  if (options.cache.node_spacing) {
    // The given spacing applies to all instances.
    found.spacing = *options.cache.node_spacing;
    std::fill(found.scales.begin(), found.scales.end(), 1.0f);
  }
  const float diagonal = scene.bounds.isEmpty() ? 1.0f : scene.bounds.diagonal().norm();
  setup.node_spacing = found.spacing > 0.0f ? found.spacing : std::max(0.01f * diagonal, 1e-30f);
  setup.spacing_scales = std::move(found.scales);
}

}  // namespace

Scouting::Scouting() = default;
Scouting::~Scouting() = default;

void Scouting::add(const World& world, const Camera& camera, const PixelRect& region,
                   const RenderOptions& options, RecordExchange exchange) {
  if (!found_) found_ = std::make_unique<Scouted>(world.scene.instances.size());
  Scouted& found = *found_;
  const RenderOptions plain = plain_options(options);
  const TrainingPoints points(world, camera, region, plain, {}, nullptr);
  RayCounts rays;
  const auto [traced, hits] = scout_camera_rays(world, points, rays, found);
  if (exchange.counts_common_rays()) found.rays.add(rays);
  if (options.integrator == Integrator::nrc)
    return scout_paths(world, camera, options, points, exchange, found);
  found.paths += traced;
  found.records += hits;
  found.records_if_short += hits;
}

ScoutReport Scouting::report(const scene::Scene& scene, const RenderOptions& options) const {
  const Scouted& found = *found_;
  ScoutReport report{.rays = found.rays};
  CacheSetup& setup = report.setup;
  const auto full = options.integrator == Integrator::nrc
                        ? static_cast<double>(options.cache.self_training.full_fraction)
                        : 1.0;
  setup.records_per_path = records_per_path(found.records, found.paths);
  setup.records_per_short_path =
      records_per_path(full * found.records + (1.0 - full) * found.records_if_short, found.paths);
  const double mean = robust_mean(found.luminances);
  if (mean > 0.0) setup.target_scale = static_cast<float>(std::clamp(1.0 / mean, 1e-37, 1e37));
  for (std::size_t i = 0; i < scene.instances.size(); ++i)
    setup.sides.push_back(stored_sides(scene, scene.instances[i], found.sides[i], options.cache.scout));
  choose_spacing(scene, options, found, setup);
  return report;
}

}  // namespace gatelight::renderer

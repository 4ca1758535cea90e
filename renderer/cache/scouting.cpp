#include "renderer/cache/scouting.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "renderer/cache/node_spacing.h"
#include "renderer/cache/radiance_records.h"
#include "renderer/cache/record_exchange.h"
#include "renderer/cache/scene_layout.h"
#include "renderer/ranks/packing.h"

namespace gatelight::renderer {
namespace {

/// Paths that are followed to their ends, and additional camera rays. An object of a thousandth of the
/// picture is missed by the former with a probability of 1e-14.
constexpr std::size_t kPaths = std::size_t{1} << 15;
constexpr std::size_t kCameraRays = std::size_t{1} << 17;
/// No training step has this number, so scouting has random numbers of its own.
constexpr std::uint64_t kStep = ~std::uint64_t{0};

/// Node spacing over the height of the picture (README.md, "What a scene requires"). Occlusion is sharper
/// than radiance and cheaper to learn.
constexpr float kRadianceSpacing = 0.03f;
constexpr float kOcclusionSpacing = 0.015f;

/// The area of each instance in square metres.
std::vector<double> areas_of(const scene::Scene& scene) {
  std::vector<double> areas(scene.instances.size(), 0.0);
  tbb::parallel_for(std::size_t{0}, areas.size(), [&](std::size_t i) {
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
  return records > 0.0 ? static_cast<float>(std::max(records / paths, double{kLeastRecordsPerPath})) : 1.0f;
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

void mark(std::vector<std::uint8_t>& met, std::uint32_t surface) {
  met[surface / 2] = static_cast<std::uint8_t>(met[surface / 2] | (1u << (surface % 2)));
}

}  // namespace

ScoutReport scout(const World& world, const Camera& camera, const PixelRect& region,
                  const RenderOptions& options, const RankTiles* ranks) {
  ScoutReport report;
  const scene::Scene& scene = world.scene;
  RenderOptions plain = options;
  plain.cache.source = TrainingSource::camera;
  plain.cache.candidates = 1;
  plain.cache.samples_per_point = 1;
  const StoredSurfaces everything;
  const TrainingPoints points(world, camera, region, plain, {}, nullptr);
  std::vector<std::uint8_t> met(scene.instances.size(), 0);
  PixelWidths widths(scene.instances.size());
  std::size_t hits = 0;

  TrainingStarts starts;
  points.choose(kStep, kCameraRays, true, {}, starts, report.rays);
  if (ranks && !ranks->ranks.first()) report.rays = {};  // all ranks trace them
  for (std::size_t i = 0; i < starts.starts.size(); ++i) {
    const Hit& hit = starts.hits[i];
    if (!hit) continue;
    const Ray& ray = starts.starts[i].sample.camera_ray.ray;
    mark(met, seen_surface(scene, hit, ray.direction));
    const RayCone& cone = starts.starts[i].sample.camera_ray.cone;
    widths.add_seen(hit.instance, cone.width + cone.spread * hit.t);
    ++hits;
  }

  if (options.integrator == Integrator::nrc) {
    const CachedPaths paths(world, cached_paths_options(plain), everything);
    PointInputs inputs;
    inputs.positions = true;
    RadianceRecords records(paths, points, plain, inputs);
    RecordBatch batch;
    const RecordRequest request{.step = kStep - 1, .points = kPaths, .ranks = ranks};
    records.trace(request, batch);
    records.finish({}, batch);
    if (ranks) {
      Bytes mine = pack_records(batch, *ranks, {});
      unpack_records(ranks->ranks.gather(std::move(mine)), *ranks, batch);
    }
    records.deal(request, batch);
    report.rays.add(records.rays());

    double all = 0.0;
    double few = 0.0;
    std::vector<double> luminances;
    for (const PathBatch& block : batch.paths) {
      for (const int n : records_by_path(block)) {
        all += n;
        few += std::min(n, options.cache.self_training.vertices);
      }
    }
    if (ranks) {  // the numbers are whole, so their sums are exact
      all = sum_of_all(ranks->ranks, all);
      few = sum_of_all(ranks->ranks, few);
    }
    for (std::size_t i = 0; i < batch.records.size(); ++i) {
      mark(met, batch.records.surface(i));
      const Color target = Eigen::Map<const Color>(&batch.targets[3 * i]);
      const double l = static_cast<double>(scene::luminance(target));
      if (!std::isfinite(l)) continue;
      luminances.push_back(l);
    }
    const CameraRay eye =
        camera.ray(0.5f * static_cast<float>(options.width), 0.5f * static_cast<float>(options.height));
    for (std::size_t i = 0; i < batch.records.size(); ++i) {
      const Eigen::Map<const Vec3> position(batch.records.batch().positions[i].data());
      const float distance = (position - eye.ray.origin).norm();
      widths.add_met(batch.records.surface(i) / 2, eye.cone.width + eye.cone.spread * distance);
    }
    const double traced = static_cast<double>(batch.paths_traced);
    const double full = static_cast<double>(options.cache.self_training.full_fraction);
    report.setup.records_per_path = records_per_path(all, traced);
    report.setup.records_per_short_path = records_per_path(full * all + (1.0 - full) * few, traced);
    const double mean = robust_mean(luminances);
    if (mean > 0.0) report.setup.target_scale = static_cast<float>(std::clamp(1.0 / mean, 1e-37, 1e37));
  } else {
    report.setup.records_per_path =
        records_per_path(static_cast<double>(hits), static_cast<double>(starts.starts.size()));
    report.setup.records_per_short_path = report.setup.records_per_path;
  }

  report.setup.sides.resize(scene.instances.size());
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const auto possible = static_cast<unsigned>(possible_sides(scene, scene.instances[i]));
    unsigned sides = possible;
    if (options.cache.scout) {
      sides = met[i] & possible;
      // A back that materials do not distinguish from the front shares its storage.
      if (met[i] != 0 && sides == 0) sides = possible;
    }
    report.setup.sides[i] = static_cast<neural::Sides>(sides);
  }
  const float of_height = options.integrator == Integrator::nao ? kOcclusionSpacing : kRadianceSpacing;
  NodeSpacing found = widths.spacing(of_height * static_cast<float>(options.height), areas_of(scene));
  if (options.cache.node_spacing) {
    // The given spacing holds for all instances.
    found.spacing = *options.cache.node_spacing;
    std::fill(found.scales.begin(), found.scales.end(), 1.0f);
  }
  const float diagonal = scene.bounds.isEmpty() ? 1.0f : scene.bounds.diagonal().norm();
  report.setup.node_spacing = found.spacing > 0.0f ? found.spacing : std::max(0.01f * diagonal, 1e-30f);
  report.setup.spacing_scales = std::move(found.scales);
  return report;
}

}  // namespace gatelight::renderer

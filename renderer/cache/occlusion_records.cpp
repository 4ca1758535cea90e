#include "renderer/cache/occlusion_records.h"

#include <mutex>

#include "base/parallel/loops.h"
#include "renderer/cache/record_exchange.h"
#include "renderer/transport/occlusion.h"

namespace gatelight::renderer {

OcclusionRecords::OcclusionRecords(const World& world, const TrainingPoints& points,
                                   const RenderOptions& options, const StoredSurfaces& stored, float distance,
                                   const PointInputs& inputs)
    : world_(world),
      points_(points),
      options_(options),
      stored_(stored),
      distance_(distance),
      inputs_(inputs) {}

void OcclusionRecords::trace(const RecordRequest& request, RecordBatch& batch) {
  RayCounts by_all;  // all ranks trace them, and one counts them
  const bool counting = !request.ranks || request.ranks->ranks.first();
  points_.choose(request.step, request.points, false, request.counts, batch.starts,
                 counting ? rays_ : by_all);
  if (request.ranks) choose_tracers(batch, *request.ranks);
  if (batch.starts.hits.empty())
    points_.trace(
        batch.starts, [&](std::size_t block) { return batch.mine(block); }, rays_);
  const auto times = static_cast<std::size_t>(options_.cache.samples_per_point);
  batch.paths.assign(batch.starts.blocks(), PathBatch(inputs_));
  std::mutex mutex;
  for_each(batch.paths.size(), [&](std::size_t b) {
    if (!batch.mine(b)) return;
    SurfacePoints& records = batch.paths[b].records;
    std::vector<float>& targets = batch.paths[b].targets;
    RayCounts counts;
    OcclusionRays rays;
    for (std::size_t i = batch.starts.offsets[b]; i < batch.starts.offsets[b + 1]; ++i) {
      const Hit& hit = batch.starts.hits[i];
      if (!hit) continue;
      const CameraSample& start = batch.starts.starts[i].sample;
      const Vec3& direction = start.camera_ray.ray.direction;
      const Surface surface = world_.surfaces.at(hit, direction, 0.0f, 0.5f);
      const std::uint32_t side = side_of(surface.front, world_.scene.instances[hit.instance].mirrors);
      if (!stored_(neural::surface_index(hit.instance, side))) continue;
      // The rays of one point are consecutive: the first makes the record.
      if (i % times == 0) {
        records.push_back(surface_point(hit, side, -direction, surface, surface.material.base_color));
        targets.push_back(0.0f);
      }
      rays.add(surface, start, distance_, targets.size() - 1);
    }
    rays.trace(world_, counts, [&](std::size_t record, const Color& open) {
      targets[record] += luminance(open) / static_cast<float>(times);
    });
    const std::lock_guard lock(mutex);
    rays_.add(counts);
  });
}

}  // namespace gatelight::renderer

#include "renderer/cache/occlusion_records.h"

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

void OcclusionRecords::begin(const RecordRequest& request, RecordBatch& batch) {
  RayCounts uncounted;
  points_.choose(request.step, request.points, false, request.counts, batch.starts,
                 request.counts_choice ? start_rays_ : uncounted);
  needs_hits_ = batch.starts.hits.empty();
  batch.starts.hits.resize(batch.starts.starts.size());
  batch.paths.assign(batch.starts.blocks(), PathBatch(inputs_));
}

void OcclusionRecords::trace(RecordBatch& batch, std::size_t block) {
  if (!batch.mine(block)) return;
  RayCounts& counts = counts_.local();
  if (needs_hits_) points_.trace(batch.starts, block, counts);
  const auto times = static_cast<std::size_t>(options_.cache.samples_per_point);
  SurfacePoints& records = batch.paths[block].records;
  std::vector<float>& targets = batch.paths[block].targets;
  OcclusionRays rays;
  for (std::size_t i = batch.starts.offsets[block]; i < batch.starts.offsets[block + 1]; ++i) {
    const Hit& hit = batch.starts.hits[i];
    if (!hit) continue;
    const CameraSample& start = batch.starts.starts[i].sample;
    const Vec3& direction = start.camera_ray.ray.direction;
    const Surface surface = world_.surfaces.at(hit, direction, 0.0f, 0.5f);
    const std::uint32_t side = side_of(surface.front, world_.scene.instances[hit.instance].swaps_handedness);
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
}

RayCounts OcclusionRecords::rays() const {
  RayCounts sum = start_rays_;
  for (const RayCounts& part : counts_) sum.add(part);
  return sum;
}

}  // namespace gatelight::renderer

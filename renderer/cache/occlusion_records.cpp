#include "renderer/cache/occlusion_records.h"

#include <tbb/parallel_for.h>

#include <mutex>

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
  points_.choose(request.step, request.points, true, request.counts, batch.starts, rays_);
  const auto times = static_cast<std::size_t>(options_.cache.samples_per_point);
  const std::size_t blocks = batch.starts.blocks();
  std::vector<SurfacePoints> records(blocks, SurfacePoints(inputs_));
  std::vector<std::vector<float>> targets(blocks);
  std::mutex mutex;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
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
      // The paths of one point stand in a row: the first makes the record.
      if (i % times == 0) {
        records[b].push_back(hit, side, -direction, surface, surface.material.base_color);
        targets[b].push_back(0.0f);
      }
      rays.add(surface, start, distance_, targets[b].size() - 1);
    }
    rays.trace(world_, counts, [&](std::size_t record, const Color& open) {
      targets[b][record] += scene::luminance(open) / static_cast<float>(times);
    });
    const std::lock_guard lock(mutex);
    rays_.add(counts);
  });

  std::size_t size = 0;
  for (const SurfacePoints& r : records) size += r.size();
  batch.dealing = Dealing(size, request.most_records, request.batches);
  if (batch.records.inputs() != inputs_) batch.records = SurfacePoints(inputs_);
  batch.records.resize(batch.dealing.kept());
  batch.targets.resize(batch.dealing.kept());
  std::size_t record = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    for (std::size_t i = 0; i < records[b].size(); ++i, ++record) {
      if (!batch.dealing.keeps(record)) continue;
      const std::size_t at = batch.dealing.place(record);
      batch.records.copy(records[b], i, 1, at);
      batch.targets[at] = targets[b][i];
    }
  }
  batch.paths_traced = batch.starts.starts.size();
  batch.records_made = size;
}

}  // namespace gatelight::renderer

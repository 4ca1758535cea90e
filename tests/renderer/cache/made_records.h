#pragma once
// The records of one request.

#include <utility>
#include <vector>

#include "renderer/cache/radiance_records.h"
#include "tests/renderer/cache/small_worlds.h"

namespace gatelight::renderer {

inline PointInputs with_positions() {
  PointInputs inputs;
  inputs.positions = true;
  return inputs;
}

struct MadeRecords {
  MadeRecords(const testing::ViewedWorld& viewed, const RenderOptions& options, const RecordRequest& request,
              const AnswerPoints& answer = {}) {
    const StoredSurfaces stored;
    const CachedPaths paths(viewed.world, cached_paths_options(options), stored);
    const std::vector<neural::Sides> sides(viewed.world.scene.instances.size(), neural::Sides::both);
    const TrainingPoints points(viewed.world, viewed.camera, viewed.region, options, sides, nullptr);
    RadianceRecords records(paths, points, options, with_positions());
    records.begin(request, batch);
    records.trace(batch);
    records.finish(answer, batch);
    records.split(request, batch);
  }
  std::uint32_t instance(std::size_t i) const { return batch.records.surface(i) / 2; }

  RecordBatch batch;
};

}  // namespace gatelight::renderer

#include "renderer/cache/record_batch.h"

#include <tbb/parallel_for.h>

namespace gatelight::renderer {

void RecordBatch::deal(const RecordRequest& request, const PointInputs& inputs, std::size_t outputs) {
  const std::vector<std::size_t> offsets =
      offsets_of(paths, [](const PathBatch& p) { return p.records.size(); });
  dealing = Dealing(offsets.back(), request.most_records, request.batches);
  if (records.inputs() != inputs) records = SurfacePoints(inputs);
  records.resize(dealing.kept());
  targets.resize(outputs * dealing.kept());
  tbb::parallel_for(std::size_t{0}, paths.size(), [&](std::size_t b) {
    for (std::size_t i = 0; i < paths[b].records.size(); ++i) {
      const std::size_t record = offsets[b] + i;
      if (!dealing.keeps(record)) continue;
      const std::size_t at = dealing.place(record);
      records.copy(paths[b].records, i, 1, at);
      for (std::size_t o = 0; o < outputs; ++o)
        targets[outputs * at + o] = paths[b].targets[outputs * i + o] * request.target_scale;
    }
  });
  paths_traced = starts.starts.size();
}

}  // namespace gatelight::renderer

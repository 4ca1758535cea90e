#include "renderer/cache/record_batch.h"

#include <tbb/enumerable_thread_specific.h>

#include <cassert>

#include "base/parallel/loops.h"

namespace gatelight::renderer {

void RecordBatch::add_to(Film& film, const RenderOptions& options, const RankTiles* ranks,
                         SampleCounts& counts) const {
  tbb::enumerable_thread_specific<SampleCounts> parts;
  for_each(radiance.empty() ? 0 : starts.blocks(), [&](std::size_t b) {
    std::vector<PixelSample> samples;
    std::vector<SampleResult> results;
    std::vector<FirstHit> hits;
    for (std::size_t i = starts.offsets[b]; i < starts.offsets[b + 1]; ++i) {
      const PixelSample& sample = starts.samples[i];
      if (ranks && !ranks->owns(sample.pixel)) continue;
      [[maybe_unused]] const PixelSample taken = film.take(sample.pixel);
      assert(taken.number == sample.number);
      samples.push_back(sample);
      results.push_back({radiance[i]});
      if (film.needs_first_hits()) hits.push_back(first_hits[i]);
    }
    add_to_film(samples, options, results, hits, film, parts.local());
  });
  for (const SampleCounts& part : parts) counts.add(part);
  keep_first(counts.located);
}

void RecordSource::trace(const RecordRequest& request, RecordBatch& batch) {
  begin(request, batch);
  for_each(batch.starts.blocks(), [&](std::size_t block) { trace(batch, block); });
}

void RecordBatch::split(const RecordRequest& request, const PointInputs& inputs, std::size_t outputs) {
  const std::vector<std::size_t> offsets =
      offsets_of(paths, [](const PathBatch& p) { return p.records.size(); });
  batch_split = BatchSplit(offsets.back(), request.most_records, request.batches);
  if (records.inputs() != inputs) records = SurfacePoints(inputs);
  records.resize(batch_split.kept());
  targets.resize(outputs * batch_split.kept());
  for_each(paths.size(), [&](std::size_t b) {
    for (std::size_t i = 0; i < paths[b].records.size(); ++i) {
      const std::size_t record = offsets[b] + i;
      if (!batch_split.keeps(record)) continue;
      const std::size_t at = batch_split.place(record);
      records.copy(paths[b].records, i, 1, at);
      for (std::size_t o = 0; o < outputs; ++o)
        targets[outputs * at + o] = paths[b].targets[outputs * i + o] * request.target_scale;
    }
  });
  paths_traced = starts.starts.size();
}

}  // namespace gatelight::renderer

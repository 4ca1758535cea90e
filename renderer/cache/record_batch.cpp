#include "renderer/cache/record_batch.h"

#include <tbb/enumerable_thread_specific.h>

#include <cassert>

#include "base/parallel/loops.h"

namespace gatelight::renderer {

void RecordBatch::add_to(Film& film, const RenderOptions& options,
                         const std::function<bool(const Pixel&)>& wanted, SampleCounts& counts) const {
  tbb::enumerable_thread_specific<SampleCounts> counted;
  for_each(radiance.empty() ? 0 : starts.blocks(), [&](std::size_t b) {
    std::vector<PixelSample> samples;
    std::vector<SampleResult> results;
    std::vector<FirstHit> hits;
    std::vector<Color> light;
    const std::size_t count = film.parts().size();
    for (std::size_t i = starts.offsets[b]; i < starts.offsets[b + 1]; ++i) {
      const PixelSample& sample = starts.samples[i];
      if (!wanted(sample.pixel)) continue;
      [[maybe_unused]] const PixelSample taken = film.take(sample.pixel);
      assert(taken.number == sample.number);
      samples.push_back(sample);
      results.push_back({radiance[i]});
      if (film.needs_first_hits()) hits.push_back(first_hits[i]);
      const auto begin = parts.begin() + static_cast<std::ptrdiff_t>(i * count);
      light.insert(light.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
    }
    add_to_film(samples, options, results, hits, film, counted.local(), light);
  });
  for (const SampleCounts& part : counted) counts.add(part);
  keep_first(counts.located);
}

void RecordSource::trace(RecordBatch& batch) {
  for_each(batch.starts.blocks(), [&](std::size_t block) { trace(batch, block); });
}

void RecordSource::split(const RecordRequest& request, RecordBatch& batch) const {
  const std::vector<std::size_t> offsets =
      offsets_of(batch.paths, [](const PathBatch& p) { return p.records.size(); });
  BatchSplit& split = batch.batch_split;
  split = BatchSplit(offsets.back(), request.most_records, request.batches);
  const std::size_t each = outputs();
  if (batch.records.inputs() != inputs()) batch.records = SurfacePoints(inputs());
  batch.records.resize(split.kept());
  batch.targets.resize(each * split.kept());
  for_each(batch.paths.size(), [&](std::size_t b) {
    const PathBatch& paths = batch.paths[b];
    for (std::size_t i = 0; i < paths.records.size(); ++i) {
      const std::size_t record = offsets[b] + i;
      if (!split.keeps(record)) continue;
      const std::size_t at = split.place(record);
      batch.records.copy(paths.records, i, 1, at);
      for (std::size_t o = 0; o < each; ++o)
        batch.targets[each * at + o] = paths.targets[each * i + o] * request.target_scale;
    }
  });
  batch.paths_traced = batch.starts.starts.size();
}

}  // namespace gatelight::renderer

#include "renderer/cache/radiance_records.h"

#include <algorithm>

#include "base/parallel/loops.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {
namespace {

/// PathPlan::contribution_threshold over the mean target. It does not change the error of the trained cache
/// (transport/README.md).
constexpr float kThresholdShare = 0.3f;

}  // namespace

RadianceRecords::RadianceRecords(const CachedPaths& paths, const TrainingPoints& points,
                                 const RenderOptions& options, const PointInputs& inputs)
    : paths_(paths), points_(points), options_(options), inputs_(inputs) {
  guides_ = has(options.aovs, Aov::cache_radiance);
  passes_ = passes_among(options.aovs).size();
}

RecordRequest RadianceRecords::request(const CacheSetup& setup, std::uint64_t step, std::uint64_t records,
                                       bool to_the_end) const {
  const int start = options_.cache.self_training.start_step;
  RecordRequest request{.step = step,
                        .target_scale = setup.target_scale,
                        .contribution_threshold = kThresholdShare / setup.target_scale};
  request.to_the_end = to_the_end;
  request.self_training = !to_the_end && start >= 0 && step >= static_cast<std::uint64_t>(start);
  request.samples = options_.cache.source == TrainingSource::picture &&
                    step >= static_cast<std::uint64_t>(options_.cache.samples_from_step);
  double per_point =
      static_cast<double>(request.self_training ? setup.records_per_short_path : setup.records_per_path);
  // The first records of a point's paths are merged into one.
  per_point += (options_.cache.samples_per_point - 1) * (per_point - std::min(per_point, 1.0));
  // A few points more than needed: the number of records varies, and excess records are left out.
  request.points = points_for(1.03 * static_cast<double>(records), per_point);
  return request;
}

void RadianceRecords::begin(const RecordRequest& request, RecordBatch& batch) {
  RayCounts uncounted;
  points_.choose(request.step, request.points, false, request.counts, batch.starts,
                 request.counts_choice ? start_rays_ : uncounted,
                 request.samples ? std::optional(request.first_sample) : std::nullopt);
  const bool samples = !batch.starts.samples.empty();
  batch.first_hits.resize(samples ? batch.starts.starts.size() : 0);
  batch.traced.resize(samples && request.to_the_end ? batch.starts.starts.size() : 0);
  PathPlan& plan = batch.plan = {};
  plan.records = true;
  if (samples) {
    plan.samples_at = options_.cache.query_at;
    plan.guides = guides_;
    plan.passes = passes_ > 0;
  }
  plan.end_after_records = request.self_training ? options_.cache.self_training.vertices : kNone;
  // In a path of limited length later vertices have less light than the first, at the same nodes. So only the
  // first vertex becomes a record.
  plan.max_depth = options_.cache.path_length > 0 ? options_.cache.path_length : kNoDepthLimit;
  plan.most_records = options_.cache.path_length > 0 ? 1 : kNone;
  plan.min_depth = options_.min_depth;
  plan.contribution_threshold = request.contribution_threshold;
  while (batch.paths.size() < batch.starts.blocks()) batch.paths.emplace_back(inputs_);
  batch.paths.resize(batch.starts.blocks());
}

void RadianceRecords::trace(RecordBatch& batch, std::size_t block) {
  if (!batch.mine(block)) return batch.paths[block].begin(0);
  Worker& worker = workers_.local();
  const std::size_t begin = batch.starts.offsets[block];
  const std::size_t size = batch.starts.offsets[block + 1] - begin;
  std::span<const Hit> hits;
  if (!batch.starts.hits.empty()) hits = std::span<const Hit>(batch.starts.hits).subspan(begin, size);
  std::span<FirstHit> first_hits;
  if (!batch.first_hits.empty()) first_hits = std::span(batch.first_hits).subspan(begin, size);
  paths_.trace(std::span<const PathStart>(batch.starts.starts).subspan(begin, size), hits, batch.plan,
               batch.paths[block], first_hits, worker.rays, worker.scratch);
}

template <class Points, class Use>
void RadianceRecords::ask_together(const AnswerPoints& answer, RecordBatch& batch, const Points& points,
                                   const Use& use) const {
  const std::size_t blocks = batch.paths.size();
  std::vector<SurfacePoints> own(blocks, SurfacePoints(inputs_));
  std::vector<const SurfacePoints*> asked(blocks);
  for_each(blocks, [&](std::size_t block) { asked[block] = &points(batch.paths[block], own[block]); });
  std::vector<std::size_t> offsets(1, 0);
  for (const SurfacePoints* const of_block : asked) offsets.push_back(offsets.back() + of_block->size());
  SurfacePoints all(inputs_);
  all.resize(offsets.back());
  for_each(blocks,
           [&](std::size_t block) { all.copy(*asked[block], 0, asked[block]->size(), offsets[block]); });
  std::vector<float> answers(3 * all.size());
  if (all.size() > 0) answer.ask(all, answers);
  for_each(blocks, [&](std::size_t block) {
    use(std::span(answers).subspan(3 * offsets[block], 3 * asked[block]->size()), block);
  });
}

void RadianceRecords::finish(const AnswerPoints& answer, RecordBatch& batch) {
  const bool samples = !batch.starts.samples.empty();
  batch.radiance.resize(batch.starts.samples.size());
  batch.parts.resize(passes_ * batch.starts.samples.size());
  const auto queries = [](const PathBatch& paths, SurfacePoints&) -> const SurfacePoints& {
    return paths.queries;
  };
  const auto ends = [](const PathBatch& paths, SurfacePoints& own) -> const SurfacePoints& {
    own.resize(paths.count_ends());
    paths.copy_ends(own, 0);
    return own;
  };
  const auto resolve_block = [&](std::span<float> answers, std::size_t block) {
    resolve(answers, batch, block);
  };
  const auto end_block = [&](std::span<const float> answers, std::size_t block) {
    const std::size_t first = batch.starts.offsets[block];
    const auto radiance = std::span(batch.radiance).subspan(first, batch.paths[block].paths());
    if (!batch.traced.empty()) std::copy(radiance.begin(), radiance.end(), &batch.traced[first]);
    batch.paths[block].end_samples(answers, radiance);
    const std::span<const Color> parts = batch.paths[block].parts.values();
    std::copy(parts.begin(), parts.end(), batch.parts.begin() + static_cast<std::ptrdiff_t>(first * passes_));
  };
  if (!answer.threads) {  // a device, which needs the points of all blocks at once
    ask_together(answer, batch, queries, resolve_block);
    if (samples) ask_together(answer, batch, ends, end_block);
    return;
  }
  for_each(batch.paths.size(), [&](std::size_t block) {
    const auto ask = [&](const auto& points, const auto& use) {
      SurfacePoints own(inputs_);
      const SurfacePoints& asked = points(batch.paths[block], own);
      std::vector<float> answers(3 * asked.size());
      if (asked.size() > 0) answer.ask(asked, answers);
      use(std::span<float>(answers), block);
    };
    ask(queries, resolve_block);
    if (samples) ask(ends, end_block);
  });
}

void RadianceRecords::resolve(std::span<float> answers, RecordBatch& batch, std::size_t block) const {
  const float attenuation = options_.cache.self_training.attenuation;
  if (attenuation != 1.0f) {
    for (float& a : answers) a *= attenuation;
  }
  PathBatch& paths = batch.paths[block];
  std::span<Color> radiance;
  if (!batch.radiance.empty()) {
    const std::size_t first = batch.starts.offsets[block];
    radiance = std::span(batch.radiance).subspan(first, paths.paths());
    if (guides_) paths.write_guides(answers, std::span(batch.first_hits).subspan(first, radiance.size()));
  }
  paths.resolve(answers, radiance);
  const auto times = static_cast<std::size_t>(options_.cache.samples_per_point);
  if (times > 1) paths.average_first_records(times);
}

RayCounts RadianceRecords::rays() const {
  RayCounts sum = start_rays_;
  for (const Worker& w : workers_) sum.add(w.rays);
  return sum;
}

}  // namespace gatelight::renderer

#include "renderer/cache/radiance_records.h"

#include <algorithm>

#include "base/parallel/loops.h"
#include "renderer/cache/record_exchange.h"
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
}

RecordRequest RadianceRecords::request(const CacheSetup& setup, std::uint64_t step,
                                       std::uint64_t records) const {
  const int start = options_.cache.self_training.start_step;
  RecordRequest request{.step = step,
                        .target_scale = setup.target_scale,
                        .contribution_threshold = kThresholdShare / setup.target_scale};
  request.self_training = start >= 0 && step >= static_cast<std::uint64_t>(start);
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

void RadianceRecords::trace(const RecordRequest& request, RecordBatch& batch) {
  RayCounts by_all;  // all ranks trace them, and one counts them
  const bool counting = !request.ranks || request.ranks->ranks.first();
  points_.choose(request.step, request.points, false, request.counts, batch.starts,
                 counting ? start_rays_ : by_all,
                 request.samples ? std::optional(request.first_sample) : std::nullopt);
  if (request.ranks) choose_tracers(batch, *request.ranks);
  const bool samples = !batch.starts.samples.empty();
  batch.first_hits.resize(samples ? batch.starts.starts.size() : 0);
  PathPlan plan;
  plan.records = true;
  if (samples) {
    plan.samples_at = options_.cache.query_at;
    plan.guides = guides_;
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
  for_each(batch.paths.size(), [&](std::size_t b) {
    if (!batch.mine(b)) return batch.paths[b].begin(0);
    Worker& worker = workers_.local();
    const std::size_t begin = batch.starts.offsets[b];
    const std::size_t size = batch.starts.offsets[b + 1] - begin;
    std::span<const Hit> hits;
    if (!batch.starts.hits.empty()) hits = std::span<const Hit>(batch.starts.hits).subspan(begin, size);
    paths_.trace(std::span<const PathStart>(batch.starts.starts).subspan(begin, size), hits, plan,
                 batch.paths[b],
                 samples ? std::span(batch.first_hits).subspan(begin, size) : std::span<FirstHit>(),
                 worker.rays, worker.scratch);
  });
}

void RadianceRecords::finish(const AnswerPoints& answer, RecordBatch& batch) {
  const std::vector<std::size_t> query_offsets =
      offsets_of(batch.paths, [](const PathBatch& p) { return p.queries.size(); });
  batch.queries = SurfacePoints(inputs_);
  batch.queries.resize(query_offsets.back());
  batch.answers.resize(3 * query_offsets.back());
  for_each(batch.paths.size(), [&](std::size_t b) {
    batch.queries.copy(batch.paths[b].queries, 0, batch.paths[b].queries.size(), query_offsets[b]);
  });
  if (!batch.answers.empty()) {
    answer(batch.queries, batch.answers);
    const float attenuation = options_.cache.self_training.attenuation;
    if (attenuation != 1.0f) {
      for (float& a : batch.answers) a *= attenuation;
    }
  }
  const bool samples = !batch.starts.samples.empty();
  batch.radiance.resize(batch.starts.samples.size());
  for_each(batch.paths.size(), [&](std::size_t b) {
    const std::size_t begin = 3 * query_offsets[b];
    const std::span<const float> answers =
        std::span<const float>(batch.answers).subspan(begin, 3 * query_offsets[b + 1] - begin);
    std::span<Color> radiance;
    if (samples) {
      const std::size_t first = batch.starts.offsets[b];
      radiance = std::span(batch.radiance).subspan(first, batch.paths[b].paths());
      if (guides_)
        batch.paths[b].write_guides(answers, std::span(batch.first_hits).subspan(first, radiance.size()));
    }
    batch.paths[b].resolve(answers, radiance);
    const auto times = static_cast<std::size_t>(options_.cache.samples_per_point);
    if (times > 1) batch.paths[b].average_first_records(times);
  });
  if (samples) end_samples(answer, batch);
}

/// Ends the picture's samples in the cache, at the same vertices as its other samples.
void RadianceRecords::end_samples(const AnswerPoints& answer, RecordBatch& batch) const {
  const std::vector<std::size_t> offsets =
      offsets_of(batch.paths, [](const PathBatch& p) { return p.count_ends(); });
  batch.queries.resize(offsets.back());
  batch.answers.resize(3 * offsets.back());
  for_each(batch.paths.size(),
                    [&](std::size_t b) { batch.paths[b].copy_ends(batch.queries, offsets[b]); });
  if (!batch.answers.empty()) answer(batch.queries, batch.answers);
  for_each(batch.paths.size(), [&](std::size_t b) {
    batch.paths[b].end_samples(std::span<const float>(batch.answers).subspan(3 * offsets[b]),
                               std::span(batch.radiance).subspan(batch.starts.offsets[b]));
  });
}

RayCounts RadianceRecords::rays() const {
  RayCounts sum = start_rays_;
  for (const Worker& w : workers_) sum.add(w.rays);
  return sum;
}

}  // namespace gatelight::renderer

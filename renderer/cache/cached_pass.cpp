#include "renderer/cache/cached_pass.h"

#include <algorithm>

#include "base/clock.h"
#include "base/finite_float.h"
#include "base/parallel/loops.h"
#include "neural/layout/mesh_colors.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {
namespace {

/// Tiles whose queries a device answers together.
constexpr int kTilesOfDevice = 256;

/// A pseudorandom colour for a number.
Color color_of(std::uint32_t number) {
  const std::uint32_t h = hash(number + 1u);
  return Color(static_cast<float>(h & 255u), static_cast<float>(h >> 8 & 255u),
               static_cast<float>(h >> 16 & 255u)) /
         255.0f;
}

/// The relative loss of values times `scale`: squared error over the squared luminance of the answer. In
/// double, because such squares leave the range of single precision.
float relative_error(const Color& answer, const Color& target, float scale) {
  const Eigen::Array3d y = answer.cast<double>() * static_cast<double>(scale);
  const Eigen::Array3d t = target.cast<double>() * static_cast<double>(scale);
  const double y_luminance = static_cast<double>(luminance(answer)) * static_cast<double>(scale);
  return finite_float((y - t).square().mean() / (y_luminance * y_luminance + neural::kRelativeLossEpsilon));
}

}  // namespace

CachedPass::CachedPass(const World& world, const PassContext& context, CacheSession& session)
    : world_(world),
      context_(context),
      session_(session),
      // The view of the cache shows its answers everywhere, even where it was not trained.
      stored_(context.options.cache.view == CacheOutput::cache ? StoredSurfaces() : session.stored()),
      paths_(world, cached_paths_options(context.options), stored_),
      ao_(world, resolve_ao_distance(context.options.ao_distance, world.scene.bounds)),
      needs_error_(has(context.options.aovs, Aov::cache_error)),
      queries_(session.inputs()) {
  plan_.query_at = context.options.cache.query_at;
  plan_.guides = has(context.options.aovs, Aov::cache_radiance);
  plan_.passes = context.options.integrator == Integrator::nrc && !passes_among(context.options.aovs).empty();
  plan_.max_depth = context.options.max_depth.value_or(kNoDepthLimit);
  plan_.min_depth = context.options.min_depth;
  if (context.options.cache.view == CacheOutput::cache) {
    if (plan_.query_at != QueryAt::none) plan_.query_at = QueryAt::primary;
    plan_.records = plan_.query_at == QueryAt::none;
  }
}

void CachedPass::run(int samples, Film& film, const std::function<void(double)>& report) {
  session_.answers_threads() ? run_tiles(samples, film, report) : run_batches(samples, film, report);
}

void CachedPass::run_tiles(int samples, Film& film, const std::function<void(double)>& report) {
  const Clock::time_point start = Clock::now();
  const TileGrid& grid = context_.tiles;
  each_tile(grid, report, [&](CachedWorker& worker, int number) {
    Tile& tile = worker.tile;
    grid.pixels(number, tile.pixels);
    for (int sample = 0; sample < samples; ++sample) {
      begin(tile, film, worker);
      const SurfacePoints& queries = tile.paths.queries;
      worker.answers.resize(session_.outputs() * queries.size());
      const Clock::time_point asked = Clock::now();
      if (queries.size() > 0) worker.statistics.negative_answers += session_.answer(queries, worker.answers);
      worker.statistics.render_query_seconds += seconds_since(asked);
      worker.statistics.queries += queries.size();
      worker.statistics.unstored_hits += tile.paths.unstored_hits;
      tile.answers = worker.answers;
      finish(tile, film, worker);
    }
  });
  statistics_.render_trace_seconds += seconds_since(start);
}

void CachedPass::run_batches(int samples, Film& film, const std::function<void(double)>& report) {
  const TileGrid& grid = context_.tiles;
  const std::size_t outputs = session_.outputs();
  const int chunks = (grid.count() + kTilesOfDevice - 1) / kTilesOfDevice;
  const double all = static_cast<double>(samples) * chunks;
  int done = 0;
  for (int sample = 0; sample < samples; ++sample) {
    for (int chunk = 0; chunk < chunks && !out_of_time(); ++chunk) {
      const int first_tile = chunk * kTilesOfDevice;
      const auto count = static_cast<std::size_t>(std::min(kTilesOfDevice, grid.count() - first_tile));
      tiles_.resize(std::max(tiles_.size(), count));
      Clock::time_point start = Clock::now();
      for_each(count, [&](std::size_t t) {
        grid.pixels(first_tile + static_cast<int>(t), tiles_[t].pixels);
        begin(tiles_[t], film, workers_.local());
      });
      offsets_.assign(1, 0);
      for (std::size_t t = 0; t < count; ++t)
        offsets_.push_back(offsets_.back() + tiles_[t].paths.queries.size());
      queries_.resize(offsets_.back());
      for_each(count, [&](std::size_t t) {
        const SurfacePoints& points = tiles_[t].paths.queries;
        queries_.copy(points, 0, points.size(), offsets_[t]);
      });
      answers_.resize(outputs * offsets_.back());
      statistics_.render_trace_seconds += seconds_since(start);

      start = Clock::now();
      if (queries_.size() > 0) statistics_.negative_answers += session_.answer(queries_, answers_);
      statistics_.render_query_seconds += seconds_since(start);
      statistics_.queries += queries_.size();

      start = Clock::now();
      for_each(count, [&](std::size_t t) {
        tiles_[t].answers = std::span<const float>(answers_).subspan(
            outputs * offsets_[t], outputs * (offsets_[t + 1] - offsets_[t]));
        finish(tiles_[t], film, workers_.local());
      });
      for (std::size_t t = 0; t < count; ++t) statistics_.unstored_hits += tiles_[t].paths.unstored_hits;
      statistics_.render_trace_seconds += seconds_since(start);
      report(++done / all);
    }
  }
}

void CachedPass::begin(Tile& tile, Film& film, CachedWorker& worker) const {
  if (tile.paths.queries.inputs() != session_.inputs()) tile.paths = PathBatch(session_.inputs());
  film.take(tile.pixels, tile.taken);
  make_camera_samples(tile.taken, film, context_.options, context_.camera, context_.filter, tile.samples);
  tile.first_hits.resize(film.needs_first_hits() ? tile.taken.size() : 0);
  tile.results.resize(tile.taken.size());
  context_.options.integrator == Integrator::nao ? trace_occlusion(tile, worker) : trace_paths(tile, worker);
}

void CachedPass::finish(Tile& tile, Film& film, CachedWorker& worker) const {
  context_.options.integrator == Integrator::nao ? finish_occlusion(tile) : finish_paths(tile);
  if (!tile.first_hits.empty()) describe_answers(tile, worker);
  add_to_film(tile.taken, context_.options, tile.results, tile.first_hits, film, worker.counts,
              tile.paths.parts.values());
}

void CachedPass::trace_paths(Tile& tile, CachedWorker& worker) const {
  tile.starts.resize(tile.samples.size());
  for (std::size_t i = 0; i < tile.samples.size(); ++i) tile.starts[i].sample = tile.samples[i];
  paths_.trace(tile.starts, {}, plan_, tile.paths, tile.first_hits, worker.rays, worker.scratch);
}

void CachedPass::finish_paths(Tile& tile) const {
  tile.radiance.resize(tile.samples.size());
  const std::span<const float> answers = tile.answers;
  if (plan_.guides && !tile.first_hits.empty()) tile.paths.write_guides(answers, tile.first_hits);
  tile.paths.resolve(answers, tile.radiance);
  if (context_.options.cache.view == CacheOutput::cache) {
    // Paths without a record or an answer are black.
    const bool traced = plan_.query_at == QueryAt::none;
    const std::vector<std::int32_t>& at = traced ? tile.paths.first_records : tile.paths.first_queries;
    const float* const values = traced ? tile.paths.targets.data() : answers.data();
    for (std::size_t i = 0; i < tile.radiance.size(); ++i) {
      tile.radiance[i] = at[i] == kNone
                             ? Color(Color::Zero())
                             : Color(Eigen::Map<const Color>(values + 3 * static_cast<std::size_t>(at[i])));
    }
  }
  for (std::size_t i = 0; i < tile.radiance.size(); ++i) tile.results[i].radiance = tile.radiance[i];
}

void CachedPass::trace_occlusion(Tile& tile, CachedWorker& worker) const {
  PathBatch& paths = tile.paths;
  paths.queries.clear();
  paths.first_queries.assign(tile.samples.size(), kNone);
  paths.unstored_hits = 0;
  // Without storage one ray is traced, as in the reference.
  const auto ask = [&](std::size_t i, const Hit& hit, const Surface& surface, const Ray& ray) {
    const std::uint32_t side = side_of(surface.front, world_.scene.instances[hit.instance].swaps_handedness);
    if (!stored_(neural::surface_index(hit.instance, side))) {
      ++paths.unstored_hits;
      return false;
    }
    paths.first_queries[i] = static_cast<std::int32_t>(paths.queries.size());
    paths.queries.push_back(surface_point(hit, side, -ray.direction, surface, surface.material.base_color));
    return true;
  };
  ao_.trace(tile.samples, tile.results, tile.first_hits, worker.rays, worker.occlusion, ask);
}

void CachedPass::finish_occlusion(Tile& tile) const {
  for (std::size_t i = 0; i < tile.results.size(); ++i) {
    const std::int32_t query = tile.paths.first_queries[i];
    if (query == kNone) continue;
    tile.results[i].radiance.setConstant(tile.answers[static_cast<std::size_t>(query)]);
  }
}

/// Traces the tile's paths to their ends. Returns for each path the record of worker.check at the vertex of
/// its first query: up to there both paths are the same.
std::vector<std::int32_t> CachedPass::check_records(const Tile& tile, CachedWorker& worker) const {
  PathBatch& check = worker.check;
  if (check.queries.inputs() != session_.inputs()) check = PathBatch(session_.inputs());
  PathPlan plan = plan_;
  plan.query_at = QueryAt::none;
  plan.records = true;
  plan.passes = false;
  paths_.trace(tile.starts, {}, plan, check, {}, worker.rays, worker.scratch);
  check.resolve({}, {});
  std::vector<std::int32_t> records(tile.starts.size(), kNone);
  for (const PathVertex& v : check.vertices) {
    const std::int32_t query = tile.paths.first_queries[v.path];
    if (v.record == kNone || query == kNone || records[v.path] != kNone) continue;
    if (check.records.same_point(static_cast<std::size_t>(v.record), tile.paths.queries,
                                 static_cast<std::size_t>(query)))
      records[v.path] = v.record;
  }
  return records;
}

void CachedPass::describe_answers(Tile& tile, CachedWorker& worker) const {
  const std::size_t outputs = session_.outputs();
  const neural::Model& model = session_.model();
  const bool gate = model.config.encoding == neural::FeatureEncoding::gate;
  std::vector<std::int32_t> records(tile.first_hits.size(), kNone);
  if (needs_error_ && context_.options.integrator == Integrator::nrc) records = check_records(tile, worker);
  for (std::size_t i = 0; i < tile.first_hits.size(); ++i) {
    if (tile.paths.first_queries[i] == kNone) continue;
    const auto query = static_cast<std::size_t>(tile.paths.first_queries[i]);
    FirstHit& first = tile.first_hits[i];
    first.queried = true;
    const float* const answer = &tile.answers[outputs * query];
    for (int c = 0; c < 3; ++c) first.answer[c] = answer[outputs == 3 ? c : 0];
    if (records[i] != kNone) {
      const float scale = session_.setup().target_scale;
      const Color target =
          Eigen::Map<const Color>(&worker.check.targets[3 * static_cast<std::size_t>(records[i])]);
      first.error = relative_error(first.answer, target, scale);
    }
    if (!gate) continue;
    const std::uint32_t surface = tile.paths.queries.surface(query);
    const std::uint32_t triangle = tile.paths.queries.triangle(query);
    const neural::GateSurface& s = model.gate.surfaces[surface];
    if (!session_.triangle_counts().empty() && s.triangle_count > 0)
      first.training_count = static_cast<float>(session_.triangle_counts()[s.first_triangle + triangle]);
    first.resolution =
        static_cast<float>(model.gate.levels[std::size_t{surface} * model.gate.stack].resolution);
    const neural::Float2& b = tile.paths.queries.barycentrics(query);
    const auto nodes =
        neural::gate_lookup<float>(model.gate, surface, 0, triangle, {1.0f - b[0] - b[1], b[0], b[1]});
    if (nodes) {
      const auto nearest = static_cast<std::size_t>(
          std::max_element(nodes->weights.begin(), nodes->weights.end()) - nodes->weights.begin());
      first.node = color_of(nodes->nodes[nearest]);
    }
  }
}

void CachedPass::add_to(CacheStatistics& statistics) const {
  const auto add = [&](const CacheStatistics& part) {
    statistics.queries += part.queries;
    statistics.negative_answers += part.negative_answers;
    statistics.unstored_hits += part.unstored_hits;
  };
  add(statistics_);
  double query = 0.0;  // of all threads, while others traced
  for (const CachedWorker& worker : workers_) {
    add(worker.statistics);
    query += worker.statistics.render_query_seconds / static_cast<double>(workers_.size());
  }
  statistics.render_trace_seconds += statistics_.render_trace_seconds - query;
  statistics.render_query_seconds += statistics_.render_query_seconds + query;
}

}  // namespace gatelight::renderer

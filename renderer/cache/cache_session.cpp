#include "renderer/cache/cache_session.h"

#include <fmt/format.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <numeric>
#include <utility>

#include "base/clock.h"
#include "base/errors.h"
#include "renderer/cache/cache_backend.h"
#include "renderer/cache/cache_model.h"
#include "renderer/cache/light_change.h"
#include "renderer/cache/occlusion_records.h"
#include "renderer/cache/radiance_records.h"
#include "renderer/cache/record_exchange.h"
#include "renderer/cache/scene_layout.h"
#include "renderer/cache/scouting.h"
#include "renderer/distributed/collectives.h"
#include "renderer/film/memory_estimate.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {
namespace {

/// The reported loss is the mean over this many last steps.
constexpr std::size_t kLossWindow = 64;

/// Largest number of paths of a step.
constexpr double kMostPaths = 1 << 24;

/// Records whose paths are traced together. Paths of several batches are more coherent, and threads wait less
/// often (5 to 10 % faster than single batches of 16384).
constexpr std::uint64_t kTracedRecords = 1 << 16;

/// Work of the slowest rank after which the shares of the ranks are adjusted.
constexpr double kRebalanceSeconds = 0.5;

void check_options(const RenderOptions& all) {
  const CacheOptions& options = all.cache;
  if (options.source == TrainingSource::picture && !training_gives_samples(all))
    throw BadOption(
        "training points of the picture: expected the integrator nrc with the view final, and one whole path "
        "without other candidates at each point");
  if (static_cast<double>(options.batch) * options.samples_per_point > kMostPaths) {
    throw BadOption(
        fmt::format("{} samples at each of the points of a batch of {}: expected at most {} paths",
                    options.samples_per_point, options.batch, static_cast<int>(kMostPaths)));
  }
}

void check_memory(const scene::Scene& scene, const RenderOptions& options, const neural::Model& model) {
  // Features, their average and two moments; a counter for each node.
  const std::size_t cache = model.parameters.count * 4 * sizeof(float) +
                            model.parameters.node_count * sizeof(std::uint32_t) +
                            model.gate.report.topology_bytes + model.gate.report.table_bytes;
  require_memory(fmt::format("{}: rendering with a cache of {} MiB", scene.path, cache >> 20), options,
                 estimate_memory(scene, options).total() + cache, cache);
}

bool counts_needed(const RenderOptions& options) {
  return options.cache.candidates > 1 || has(options.aovs, Aov::training_count);
}

/// Fills `answers`: as many floats for each point as the network has outputs. Outputs that are negative or
/// not finite become zero; returns the number of points that have one.
std::uint64_t ask_cache(const neural::Trainer& trainer, neural::QueryPrecision precision,
                        const AnswerUnits& units, const SurfacePoints& points, std::span<float> answers) {
  constexpr float kGreatest = std::numeric_limits<float>::max();
  trainer.query(points.batch(), {.precision = precision, .range = neural::OutputRange::raw}, answers);
  const std::size_t outputs = trainer.model().config.mlp.outputs;
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, points.size(), 4096), std::uint64_t{0},
      [&](const tbb::blocked_range<std::size_t>& range, std::uint64_t negative) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          bool below = false;
          for (float& a : answers.subspan(outputs * i, outputs)) {
            if (!(a >= 0.0f && a <= kGreatest)) {
              below = true;
              a = 0.0f;
            }
            a = std::min(a * units.scale, units.greatest);
          }
          if (below) ++negative;
        }
        return negative;
      },
      std::plus<>());
}

}  // namespace

CacheSession::CacheSession(const World& world, const Camera& camera, const PixelRect& region,
                           const RenderOptions& options, const CacheSetup* setup,
                           const std::function<void(const neural::Model&)>& expect_model,
                           const RankTiles* ranks)
    : options_(options), ranks_(ranks && !ranks->ranks.is_single() ? ranks : nullptr) {
  check_options(options);
  Clock::time_point start = Clock::now();
  if (setup) {
    setup_ = *setup;
  } else {
    Scouting scouting;
    scouting.add(world, camera, region, options, ranks_);
    ScoutReport report = scouting.report(world.scene, options);
    setup_ = std::move(report.setup);
    scout_rays_ = report.rays;
  }
  statistics_.scout_seconds = seconds_since(start);
  start = Clock::now();

  const std::shared_ptr<const neural::Model> cache_model = make_cache_model(world, options, setup_);
  if (expect_model) expect_model(*cache_model);
  check_memory(world.scene, options, *cache_model);
  trainer_ = std::make_unique<neural::Trainer>(cache_model, training_options(options),
                                               make_cache_backend(cache_model, options));
  connect(world, camera, region);
  const auto count = [](neural::Sides sides) {
    return static_cast<std::uint64_t>(std::popcount(static_cast<unsigned>(sides)));
  };
  for (std::size_t i = 0; i < setup_.sides.size(); ++i) {
    statistics_.surfaces_stored += count(setup_.sides[i]);
    statistics_.surfaces_possible += count(possible_sides(world.scene, world.scene.instances[i]));
  }
  statistics_.nodes = cache_model->parameters.node_count;
  if (cache_model->config.encoding == neural::FeatureEncoding::gate)
    statistics_.node_spacing = cache_model->gate.report.node_spacing;
  statistics_.target_scale = setup_.target_scale;
  statistics_.records_per_path = static_cast<double>(setup_.records_per_path);
  const neural::RequiredInputs required = required_inputs(world, options);
  statistics_.direction_input = required.direction;
  statistics_.normal_input = required.normal;
  statistics_.albedo_input = required.albedo;
  statistics_.resolution_histogram = cache_model->gate.report.resolution_histogram;
  statistics_.layout_bytes = cache_model->gate.report.topology_bytes + cache_model->gate.report.table_bytes;
  statistics_.parameter_bytes = trainer_->backend().parameter_bytes();
  statistics_.optimizer_bytes = trainer_->backend().optimizer_bytes();
  statistics_.backend = trainer_->backend().name();
  statistics_.setup_seconds = seconds_since(start);
  first_statistics_ = statistics_;
}

CacheSession::CacheSession(const World& world, const Camera& camera, const PixelRect& region,
                           const RenderOptions& options, CacheSession&& earlier, const RankTiles* ranks)
    : options_(options),
      ranks_(ranks && !ranks->ranks.is_single() ? ranks : nullptr),
      setup_(std::move(earlier.setup_)),
      trainer_(std::move(earlier.trainer_)),
      steps_(earlier.steps_),
      first_statistics_(earlier.first_statistics_) {
  const Clock::time_point start = Clock::now();
  const std::vector<std::uint32_t> counts(earlier.counts_.values().begin(), earlier.counts_.values().end());
  connect(world, camera, region);
  counts_.restart(counts);
  first_statistics_.scout_seconds = 0.0;
  first_statistics_.setup_seconds = seconds_since(start);
  statistics_ = first_statistics_;
}

void CacheSession::connect(const World& world, const Camera& camera, const PixelRect& region) {
  const neural::Model& model = trainer_->model();
  inputs_ = PointInputs(model.config);
  const bool gate = model.config.encoding == neural::FeatureEncoding::gate;
  if (gate) stored_ = StoredSurfaces(world.scene, setup_.sides);
  points_ = std::make_unique<TrainingPoints>(world, camera, region, options_, setup_.sides,
                                             gate ? &model.gate : nullptr);
  if (gate && counts_needed(options_))
    counts_ = TriangleCounts(model.gate, options_.cache.candidates > 1 ? points_.get() : nullptr);
  paths_ = std::make_unique<CachedPaths>(world, cached_paths_options(options_), stored_);
  if (options_.integrator == Integrator::nao) {
    records_ = std::make_unique<OcclusionRecords>(
        world, *points_, options_, stored_, resolve_ao_distance(options_.ao_distance, world.scene.bounds),
        inputs_);
  } else {
    records_ = std::make_unique<RadianceRecords>(*paths_, *points_, options_, inputs_);
  }
}

CacheSession::~CacheSession() = default;

/// Groups grow in powers of two, so that every power of two ends a group.
std::uint64_t CacheSession::group_end(std::uint64_t step) const {
  const std::uint64_t paths =
      std::uint64_t{options_.cache.batch} * static_cast<std::uint64_t>(options_.cache.samples_per_point);
  const std::uint64_t most = std::bit_floor(std::max<std::uint64_t>(kTracedRecords / paths, 1));
  const std::uint64_t size = std::min(most, std::bit_floor(std::max<std::uint64_t>(step, 1)));
  return (step / size + 1) * size;
}

std::uint64_t CacheSession::last_group_end(std::uint64_t steps) const {
  std::uint64_t last = steps_;
  while (last < steps && group_end(last) <= steps) last = group_end(last);
  return last;
}

RecordRequest CacheSession::request(std::uint64_t step, std::uint64_t count,
                                    std::uint64_t first_sample) const {
  const std::uint64_t records = options_.cache.batch * count;
  RecordRequest request = records_->request(setup_, step, records);
  request.most_records = records;
  request.batches = count;
  request.first_sample = first_sample;
  request.ranks = ranks_;
  if (options_.cache.candidates > 1) request.counts = counts_.values();
  return request;
}

void CacheSession::learn(const RecordBatch& group, std::uint64_t batch) {
  const Clock::time_point begin = Clock::now();
  trainer_->start(group.batch(batch));
  statistics_.train_step_seconds += seconds_since(begin);
  ++steps_;
  ++steps_under_way_;
  statistics_.steps += 1;
  if (!trainer_->backend().runs_alongside()) synchronize();
}

void CacheSession::synchronize() {
  const Clock::time_point begin = Clock::now();
  while (steps_under_way_ > 0) {
    const neural::StepStatistics step = trainer_->finish();
    const std::uint64_t number = steps_ - --steps_under_way_;
    statistics_.records += step.records;
    statistics_.rejected += step.rejected;
    statistics_.unstored += step.unstored;
    statistics_.touched_nodes = step.touched_nodes;
    last_losses_.push_back(step.loss);
    if (last_losses_.size() > kLossWindow) last_losses_.erase(last_losses_.begin());
    statistics_.loss = std::accumulate(last_losses_.begin(), last_losses_.end(), 0.0) /
                       static_cast<double>(last_losses_.size());
    guard_.look_at_loss(step, number);
  }
  statistics_.train_step_seconds += seconds_since(begin);
}

void CacheSession::look_at_answers(const RecordBatch& group) {
  const std::size_t some = std::min(TrainingGuard::kLookedAt, group.records.size());
  guard_.look_at_answers(group.targets, group.records.batch(0, some), *trainer_, steps_);
}

void CacheSession::trace(std::uint64_t step, std::uint64_t count, std::uint64_t first_sample, Group& group) {
  const Clock::time_point begin = Clock::now();
  const RayCounts before = records_->rays();
  group.request = request(step, count, first_sample);
  records_->trace(group.request, group.records);
  RayCounts rays = records_->rays();
  rays.subtract(before);
  group.rays = rays;
  unlearned_rays_.add(rays);
  group.work = {seconds_since(begin), rays.camera + rays.bounce + rays.shadow};
  statistics_.train_trace_seconds += group.work.seconds;
}

void CacheSession::finish(Group& group) {
  double answered = 0.0;
  const AnswerPoints answer_tail = [&](const SurfacePoints& points, std::span<float> answers) {
    const Clock::time_point begin = Clock::now();
    ask_cache(*trainer_, neural::QueryPrecision::fp32, records_->units(setup_), points, answers);
    answered += seconds_since(begin);
  };
  const Clock::time_point begin = Clock::now();
  records_->finish(answer_tail, group.records);
  const double seconds = seconds_since(begin);
  statistics_.train_query_seconds += answered;
  statistics_.train_trace_seconds += seconds - answered;
  if (!ranks_) return;
  group.work.seconds += seconds;
  Bytes packed = pack_records(group.records, *ranks_, group.work);
  record_bytes_ += packed.size();
  group.coming = ranks_->ranks.begin_gather(std::move(packed));
}

void CacheSession::learn_from(Group& group, const Watch& watch) {
  const Clock::time_point begin = Clock::now();
  RecordBatch& records = group.records;
  unlearned_rays_.subtract(group.rays);
  for (std::size_t b = 0; b < records.starts.blocks(); ++b) {
    if (records.mine(b)) paths_of_rank_ += records.starts.offsets[b + 1] - records.starts.offsets[b];
  }
  if (group.coming) {
    const std::vector<RankWork> work = unpack_records(group.coming->wait(), *ranks_, records);
    work_.resize(work.size());
    for (std::size_t r = 0; r < work.size(); ++r) {
      work_[r].seconds += work[r].seconds;
      work_[r].rays += work[r].rays;
    }
  }
  records_->split(group.request, records);
  statistics_.training_paths += records.paths_traced;
  samples_ += group.samples();
  if (watch.samples && group.samples() > 0) watch.samples(records);
  statistics_.train_trace_seconds += seconds_since(begin);
  if (watch.before_learning) watch.before_learning(records);
  for (std::uint64_t batch = 0; batch < group.steps(); ++batch) {
    counts_.add(records, batch, steps_);
    learn(records, batch);
  }
  if (!trainer_->backend().runs_alongside()) look_at_answers(records);
  const auto longer = [](const RankWork& a, const RankWork& b) { return a.seconds < b.seconds; };
  const auto longest = std::max_element(work_.begin(), work_.end(), longer);
  if (!watch.rebalance || longest == work_.end() || longest->seconds < kRebalanceSeconds) return;
  watch.rebalance(work_);
  work_.clear();
}

void CacheSession::train(std::uint64_t steps, const Watch& watch) {
  const Clock::time_point start = Clock::now();
  const double before = statistics_.train_seconds;
  const auto wanted = static_cast<int>(steps);
  // With ranks a group is traced while the records of the one before are exchanged. This is not possible
  // with candidates, which depend on the counts of the group before.
  const bool ahead = ranks_ && options_.cache.candidates == 1;
  const auto give_up = [&] {
    const double limit = options_.cache.train_seconds;
    if (watch.stop && watch.stop()) return true;
    if (limit <= 0.0) return false;
    const bool over = seconds_since(start) >= limit;
    return ranks_ ? agreed(ranks_->ranks, over) : over;
  };
  Group groups[2];
  Group *next = &groups[0], *last = ahead ? &groups[1] : next;
  Group* learning = nullptr;  // traced and finished, but not learned
  const auto learn_now = [&] {
    learn_from(*learning, watch);
    learning = nullptr;
    statistics_.train_seconds = before + seconds_since(start);
    if (watch.progress) watch.progress(static_cast<int>(steps_), wanted, statistics_.loss);
    if (watch.after_group) watch.after_group();
    return !give_up();
  };
  bool goes_on = true;
  while (goes_on) {
    const std::uint64_t under_way = learning ? learning->steps() : 0, step = steps_ + under_way;
    if (step >= steps && !learning) break;
    Group* group = nullptr;
    if (step < steps) {
      group = next;
      const std::uint64_t count = std::min(group_end(step), steps) - step;
      trace(step, count, samples_ + (learning ? learning->samples() : 0), *group);
    }
    if (learning) goes_on = learn_now();
    if (!group) continue;
    if (!goes_on) {
      // The group that was traced ahead will be traced again.
      unlearned_rays_.subtract(group->rays);
      abandoned_rays_.add(group->rays);
      break;
    }
    synchronize();  // the steps of the group before, which a device computed meanwhile
    look_at_answers(last->records);
    finish(*group);
    learning = group;
    std::swap(next, last);
    if (!ahead) goes_on = learn_now();
  }
  synchronize();
  look_at_answers(last->records);
  statistics_.train_seconds = before + seconds_since(start);
}

void CacheSession::start_anew(bool keeps_samples) {
  Snapshot start{{.setup = setup_}, first_statistics_, 0, 0, scout_rays_, {}};
  start.state.model = neural::initial_state(model(), trainer_->options());
  start.state.triangle_counts.assign(counts_.values().size(), 0);
  if (keeps_samples) start.state.samples = samples_;
  return_to(start);
}

std::uint64_t CacheSession::answer(const SurfacePoints& points, std::span<float> answers) const {
  return ask_cache(*trainer_,
                   options_.cache.bf16_queries ? neural::QueryPrecision::bf16 : neural::QueryPrecision::fp32,
                   records_->units(setup_), points, answers);
}

double CacheSession::light_change(const scene::Scene& scene, const RecordBatch& group) const {
  std::vector<float> answers(group.records.size() * outputs());
  if (answers.empty()) return 0.0;
  trainer_->query(group.records.batch(), {.range = neural::OutputRange::raw}, answers);
  return renderer::light_change(scene, group, answers, outputs());
}

void CacheSession::forget_beyond(std::uint32_t steps) {
  neural::ModelState state = trainer_->backend().export_state();
  for (std::uint32_t& age : state.node_steps) age = std::min(age, steps);
  state.steps = std::min<std::uint64_t>(state.steps, steps);
  trainer_->backend().import_state(state);
}

CacheState CacheSession::export_state() const {
  CacheState state;
  state.setup = setup_;
  state.model = trainer_->backend().export_state();
  state.steps = steps_;
  state.samples = samples_;
  state.triangle_counts = counts_.values();
  state.guard = guard_;
  return state;
}

void CacheSession::import_state(const CacheState& state) {
  // After training that ended with an exception a device may still compute steps.
  for (; steps_under_way_ > 0; --steps_under_way_) trainer_->finish();
  trainer_->backend().import_state(state.model);
  steps_ = state.steps;
  samples_ = state.samples;
  counts_.restart(state.triangle_counts);
  guard_ = state.guard;
}

CacheSession::Snapshot CacheSession::snapshot() const {
  return {export_state(), statistics_, paths_of_rank_, record_bytes_, rays(), last_losses_};
}

void CacheSession::return_to(const Snapshot& snapshot) {
  import_state(snapshot.state);
  unlearned_rays_ = {};  // of training that ended with an exception
  RayCounts abandoned = rays();
  abandoned.subtract(snapshot.rays);
  abandoned_rays_.add(abandoned);
  statistics_ = snapshot.statistics;
  paths_of_rank_ = snapshot.paths_of_rank;
  record_bytes_ = snapshot.record_bytes;
  last_losses_ = snapshot.last_losses;
}

RayCounts CacheSession::rays() const {
  RayCounts sum = scout_rays_;
  sum.add(records_->rays());
  sum.subtract(unlearned_rays_);
  sum.subtract(abandoned_rays_);
  return sum;
}

}  // namespace gatelight::renderer

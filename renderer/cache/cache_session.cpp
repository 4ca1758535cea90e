#include "renderer/cache/cache_session.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "neural/learning/record_status.h"
#include "renderer/cache/cache_backend.h"
#include "renderer/cache/cache_model.h"
#include "renderer/cache/occlusion_records.h"
#include "renderer/cache/radiance_records.h"
#include "renderer/cache/scene_layout.h"
#include "renderer/film/memory_estimate.h"
#include "renderer/machine/clock.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {
namespace {

/// The reported loss is the mean of so many last steps.
constexpr std::size_t kLossWindow = 64;

// The divergence guard: a running mean of the loss that grows tenfold over its least value. Single bright
// records raise one step's loss a thousandfold, so that the mean is slow and no step counts for more than
// tenfold; a loss that has gone to nothing may double as it likes.
constexpr double kGuardDecay = 0.995;
constexpr std::uint64_t kGuardFrom = 200;  ///< steps of this run: another camera or batch has another loss
constexpr double kGuardFactor = 10.0;
constexpr double kGuardFloor = 1e-2;

// And what no training that learns anything reaches, looked at between groups: answers that are a hundred
// times as bright as any group's targets, or a loss 130 times that of answering one everywhere. (Answers of
// nothing where rare light of t falls come to 101 t^2 / (t - 1)^2, as the relative loss divides by 0.01.) A
// loss alone would not tell: the relative one goes to one for answers without bounds.
constexpr std::size_t kLookedAt = 1024;  ///< points
constexpr double kGreatestBrightness = 100.0;
constexpr double kGreatestLoss = 130.0;
/// As good as ever: the running mean is within so much of its least, and the group's own within so much of
/// that.
constexpr double kGoodAverage = 1.25;
constexpr double kGoodGroup = 2.0;

/// Paths of one step that are held at once.
constexpr double kMostPaths = 1 << 24;

/// Records whose paths are traced in one go: those of several batches lie nearer to each other, and threads
/// wait less often (5 to 10 % faster than one batch of 16384 by itself).
constexpr std::uint64_t kTracedRecords = 1 << 16;

void check_options(const CacheOptions& options) {
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
  return options.cache.candidates > 1 ||
         std::find(options.aovs.begin(), options.aovs.end(), Aov::training_count) != options.aovs.end();
}

}  // namespace

CacheSession::CacheSession(const World& world, const Camera& camera, const PixelRect& region,
                           const RenderOptions& options, const CacheSetup* setup,
                           const std::function<void(const neural::Model&)>& expect_model)
    : world_(world), options_(options) {
  check_options(options.cache);
  Clock::time_point start = Clock::now();
  if (setup) {
    setup_ = *setup;
  } else {
    ScoutReport report = scout(world, camera, region, options);
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
  inputs_ = PointInputs(cache_model->config);
  const bool gate = cache_model->config.encoding == neural::FeatureEncoding::gate;
  if (gate) stored_ = StoredSurfaces(world.scene, setup_.sides);
  points_ = std::make_unique<TrainingPoints>(world, camera, region, options, setup_.sides,
                                             gate ? &cache_model->gate : nullptr);
  if (gate && counts_needed(options)) {
    counts_.assign(cache_model->gate.triangle_count, 0);
    counted_at_.assign(counts_.size(), 0);
  }
  paths_ = std::make_unique<CachedPaths>(world, cached_paths_options(options), stored_);
  if (options.integrator == Integrator::nao) {
    records_ = std::make_unique<OcclusionRecords>(
        world, *points_, options, stored_, resolve_ao_distance(options.ao_distance, world.scene.bounds),
        inputs_);
  } else {
    records_ = std::make_unique<RadianceRecords>(*paths_, *points_, options, inputs_);
  }

  for (std::size_t i = 0; i < setup_.sides.size(); ++i) {
    const auto sides_of = [](neural::Sides s) -> std::uint64_t {
      return s == neural::Sides::both ? 2 : s == neural::Sides::none ? 0 : 1;
    };
    statistics_.surfaces_stored += sides_of(setup_.sides[i]);
    statistics_.surfaces_possible += sides_of(possible_sides(world.scene, world.scene.instances[i]));
  }
  statistics_.nodes = cache_model->parameters.node_count;
  statistics_.node_spacing = gate ? cache_model->gate.report.node_spacing : 0.0f;
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

CacheSession::~CacheSession() = default;

/// Groups grow in powers of two, so that any power of two is the end of one.
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

RecordRequest CacheSession::request(std::uint64_t step, std::uint64_t count) const {
  const SelfTrainingOptions& self = options_.cache.self_training;
  const std::uint64_t records = options_.cache.batch * count;
  RecordRequest request;
  request.step = step;
  request.self_training = options_.integrator == Integrator::nrc && self.start_step >= 0 &&
                          step >= static_cast<std::uint64_t>(self.start_step);
  double per_point =
      static_cast<double>(request.self_training ? setup_.records_per_short_path : setup_.records_per_path);
  // The first records of a point's paths are one.
  if (options_.integrator == Integrator::nrc)
    per_point += (options_.cache.samples_per_point - 1) * (per_point - std::min(per_point, 1.0));
  // A few points more than enough: the number of records varies, and what is too much is left out.
  const double slack = options_.integrator == Integrator::nrc ? 1.03 : 1.0;
  request.points =
      static_cast<std::size_t>(std::max(1.0, std::ceil(slack * static_cast<double>(records) / per_point)));
  request.most_records = records;
  request.batches = count;
  request.target_scale = options_.integrator == Integrator::nrc ? setup_.target_scale : 1.0f;
  if (options_.cache.candidates > 1) request.counts = counts_;
  return request;
}

void CacheSession::count_triangles(const RecordBatch& group, std::uint64_t batch) {
  if (counts_.empty()) return;
  const neural::GateLayout& layout = model().gate;
  // Once a step, however many records lie on it.
  const auto count = [&](std::size_t triangle) {
    if (counted_at_[triangle] == steps_ + 1) return;
    counted_at_[triangle] = steps_ + 1;
    if (counts_[triangle] != ~0u) ++counts_[triangle];
  };
  for (std::size_t i = group.dealing.begin(batch); i < group.dealing.begin(batch + 1); ++i) {
    const neural::GateSurface& surface = layout.surfaces[group.records.surface(i)];
    if (surface.triangle_count > 0) count(surface.first_triangle + group.records.triangle(i));
  }
  if (options_.cache.candidates <= 1) return;
  // Paths that begin at a mirror leave no record there, and its triangles would be chosen ever after.
  for (std::size_t i = 0; i < group.starts.hits.size(); ++i) {
    if (!group.starts.hits[i]) continue;
    const Vec3& direction = group.starts.starts[i].sample.camera_ray.ray.direction;
    const std::uint32_t triangle = points_->triangle_number(group.starts.hits[i], direction);
    if (triangle != TrainingPoints::kNoTriangle) count(triangle);
  }
}

void CacheSession::guard(const neural::StepStatistics& step, std::uint64_t number) {
  if (step.records == 0) return;
  if (!std::isfinite(step.loss))
    throw TrainingDiverged(fmt::format("training step {}: the loss is not finite", number));
  guard_.group_loss += step.loss;
  ++guard_.group_steps;
  const double fed =
      guard_.loss_average > 0.0 ? std::min(step.loss, kGuardFactor * guard_.loss_average) : step.loss;
  guard_.loss_average = guard_.loss_average > 0.0
                            ? guard_.loss_average + (1.0 - kGuardDecay) * (fed - guard_.loss_average)
                            : fed;
  if (++guard_.steps < kGuardFrom) {
    guard_.loss_least = guard_.loss_average;
    return;
  }
  guard_.loss_least = std::min(guard_.loss_least, guard_.loss_average);
  if (guard_.loss_average > kGuardFactor * std::max(guard_.loss_least, kGuardFloor)) {
    throw TrainingDiverged(fmt::format("training step {}: the loss grew from {:.3g} to {:.3g}", number,
                                       guard_.loss_least, guard_.loss_average));
  }
}

void CacheSession::look_at_answers(const RecordBatch& group) {
  if (guard_.group_steps == 0 || group.records.size() == 0) return;
  const double loss = guard_.group_loss / static_cast<double>(guard_.group_steps);
  guard_.group_loss = 0.0;
  guard_.group_steps = 0;
  double bright = 0.0, ones = 0.0;
  for (const float t : group.targets) {
    if (!std::isfinite(t)) continue;
    const double target =
        std::min(static_cast<double>(std::abs(t)), static_cast<double>(options_.cache.training.max_target));
    bright += target;
    ones += (target - 1.0) * (target - 1.0);
  }
  const double values = static_cast<double>(group.targets.size());
  guard_.brightest = std::max(guard_.brightest, bright / values);
  if (loss > kGreatestLoss * std::max(ones / values, kGuardFloor)) {
    throw TrainingDiverged(
        fmt::format("training step {}: a loss of {:.3g}, where answering the mean has one of {:.3g}", steps_,
                    loss, ones / values));
  }

  const std::size_t points = std::min(kLookedAt, group.records.size());
  std::vector<float> answers(points * outputs());
  const neural::QueryBatch asked = group.records.batch(0, points);
  trainer_->query(asked, {.range = neural::OutputRange::raw}, answers);
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < points; ++i) {
    if (!neural::is_finite(model(), asked, i)) continue;
    for (std::size_t o = 0; o < outputs(); ++o)
      sum += static_cast<double>(std::abs(answers[i * outputs() + o]));
    count += static_cast<double>(outputs());
  }
  const double mean = count > 0.0 ? sum / count : 0.0;
  if (!(mean <= kGreatestBrightness * guard_.brightest)) {
    throw TrainingDiverged(
        fmt::format("training step {}: answers of {:.3g} in the mean, where targets are {:.3g}", steps_, mean,
                    guard_.brightest));
  }
  if (guard_.steps >= kGuardFrom && guard_.loss_average <= kGoodAverage * guard_.loss_least &&
      loss <= kGoodGroup * guard_.loss_average)
    guard_.good_steps = steps_;
}

void CacheSession::learn(const RecordBatch& group, std::uint64_t batch) {
  const Clock::time_point begin = Clock::now();
  trainer_->start(group.batch(batch));
  statistics_.train_step_seconds += seconds_since(begin);
  ++steps_;
  ++steps_under_way_;
  statistics_.steps += 1;
  if (!trainer_->backend().runs_alongside()) settle();
}

void CacheSession::settle() {
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
    guard(step, number);
  }
  statistics_.train_step_seconds += seconds_since(begin);
}

void CacheSession::train(std::uint64_t steps, const Watch& watch) {
  const Clock::time_point start = Clock::now();
  const double before = statistics_.train_seconds;
  const auto wanted = static_cast<int>(steps);
  RecordBatch group;
  const AnswerPoints answer_tail = [this](const SurfacePoints& points, std::span<float> answers) {
    const Clock::time_point begin = Clock::now();
    const std::uint64_t negative = statistics_.negative_answers;
    answer_with(neural::QueryPrecision::fp32, points, answers);
    statistics_.negative_answers = negative;
    statistics_.train_query_seconds += seconds_since(begin);
  };
  while (steps_ < steps) {
    const Clock::time_point begin = Clock::now();
    const double queried = statistics_.train_query_seconds;
    const std::uint64_t count = std::min(group_end(steps_), steps) - steps_;
    const RecordRequest wish = request(steps_, count);
    records_->trace(wish, group);
    const double stepped = statistics_.train_step_seconds;
    settle();  // the steps of the group before, which a device made meanwhile
    look_at_answers(group);
    const double waited = statistics_.train_step_seconds - stepped;
    records_->finish(wish, answer_tail, group);
    statistics_.train_trace_seconds +=
        seconds_since(begin) - waited - (statistics_.train_query_seconds - queried);
    statistics_.training_paths += group.paths_traced;
    for (std::uint64_t batch = 0; batch < count; ++batch) {
      count_triangles(group, batch);
      learn(group, batch);
    }
    if (!trainer_->backend().runs_alongside()) look_at_answers(group);
    statistics_.train_seconds = before + seconds_since(start);
    if (watch.progress) watch.progress(static_cast<int>(steps_), wanted, statistics_.loss);
    if (watch.after_group) watch.after_group();
    const double limit = options_.cache.train_seconds;
    if ((watch.stop && watch.stop()) || (limit > 0.0 && seconds_since(start) >= limit)) break;
  }
  settle();
  look_at_answers(group);
  statistics_.train_seconds = before + seconds_since(start);
}

void CacheSession::start_anew() {
  CacheState state;
  state.setup = setup_;
  state.model = neural::initial_state(model(), trainer_->options());
  state.triangle_counts.assign(counts_.size(), 0);
  import_state(state);
  RayCounts abandoned = rays();
  abandoned.subtract(scout_rays_);
  abandoned_rays_.add(abandoned);
  statistics_ = first_statistics_;
  last_losses_.clear();
}

void CacheSession::answer(const SurfacePoints& points, std::span<float> answers) {
  answer_with(options_.cache.bf16_queries ? neural::QueryPrecision::bf16 : neural::QueryPrecision::fp32,
              points, answers);
}

void CacheSession::answer_with(neural::QueryPrecision precision, const SurfacePoints& points,
                               std::span<float> answers) {
  const bool occlusion = options_.integrator == Integrator::nao;
  neural::QueryOptions query;
  constexpr float kGreatest = std::numeric_limits<float>::max();
  query.precision = precision;
  query.range = neural::OutputRange::raw;
  trainer_->query(points.batch(), query, answers);
  const float scale = 1.0f / setup_.target_scale;
  const std::size_t outputs = this->outputs();
  statistics_.negative_answers += tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, points.size(), 4096), std::uint64_t{0},
      [&](const tbb::blocked_range<std::size_t>& range, std::uint64_t negative) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          bool below = false;
          for (float& a : answers.subspan(outputs * i, outputs)) {
            if (!(a >= 0.0f && a <= kGreatest)) {
              below = true;
              a = 0.0f;
            }
            a = occlusion ? std::min(a, 1.0f) : std::min(a * scale, kGreatest);
          }
          if (below) ++negative;
        }
        return negative;
      },
      std::plus<>());
}

CacheState CacheSession::export_state() const {
  CacheState state;
  state.setup = setup_;
  state.model = trainer_->backend().export_state();
  state.steps = steps_;
  state.triangle_counts = counts_;
  state.guard = guard_;
  return state;
}

void CacheSession::import_state(const CacheState& state) {
  // Of a training that ended with an exception a device may still hold some.
  for (; steps_under_way_ > 0; --steps_under_way_) trainer_->finish();
  trainer_->backend().import_state(state.model);
  steps_ = state.steps;
  if (state.triangle_counts.size() == counts_.size()) counts_ = state.triangle_counts;
  std::fill(counted_at_.begin(), counted_at_.end(), 0);
  guard_ = state.guard;
}

CacheSession::Bookmark CacheSession::bookmark() const {
  return {export_state(), statistics_, rays(), last_losses_};
}

void CacheSession::return_to(const Bookmark& bookmark) {
  import_state(bookmark.state);
  RayCounts abandoned = rays();
  abandoned.subtract(bookmark.rays);
  abandoned_rays_.add(abandoned);
  statistics_ = bookmark.statistics;
  last_losses_ = bookmark.last_losses;
}

RayCounts CacheSession::rays() const {
  RayCounts sum = scout_rays_;
  sum.add(records_->rays());
  sum.subtract(abandoned_rays_);
  return sum;
}

}  // namespace gatelight::renderer

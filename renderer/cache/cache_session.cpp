#include "renderer/cache/cache_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <functional>
#include <limits>
#include <utility>

#include "base/clock.h"
#include "base/errors.h"
#include "base/parallel/loops.h"
#include "base/parallel/schedule.h"
#include "base/parallel/team.h"
#include "renderer/cache/cache_backend.h"
#include "renderer/cache/cache_model.h"
#include "renderer/cache/device_trial.h"
#include "renderer/cache/light_change.h"
#include "renderer/cache/occlusion_records.h"
#include "renderer/cache/radiance_records.h"
#include "renderer/cache/scene_layout.h"
#include "renderer/cache/scouting.h"
#include "renderer/film/memory_estimate.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {
namespace {

/// Largest number of paths of a step.
constexpr double kMaxPaths = 1 << 24;

void check_options(const RenderOptions& all) {
  const CacheOptions& options = all.cache;
  if (options.source == TrainingSource::picture && !training_gives_samples(all))
    throw BadOption(
        {"training-points", "picture", "cannot be combined with these options",
         "`integrator` nrc, `view` final and no `candidates`, `samples-per-point` and `train-path-length`"});
  if (static_cast<double>(options.batch) * options.samples_per_point > kMaxPaths) {
    throw BadOption({"samples-per-point", fmt::format("{}", options.samples_per_point),
                     fmt::format("is too many for a `batch` of {}", options.batch),
                     fmt::format("at most {} paths", static_cast<int>(kMaxPaths))});
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

/// Answers in the picture's units; `outputs` for each point. Those that are negative or not finite become
/// zero; returns the number of points that have one.
std::uint64_t convert_answers(const AnswerUnits& units, std::size_t outputs, std::span<float> answers) {
  constexpr float kGreatest = std::numeric_limits<float>::max();
  std::atomic<std::uint64_t> negative = 0;
  for_each_range(answers.size() / outputs, 4096, [&](std::size_t begin, std::size_t end) {
    std::uint64_t here = 0;
    for (std::size_t i = begin; i < end; ++i) {
      bool below = false;
      for (float& a : answers.subspan(outputs * i, outputs)) {
        if (!(a >= 0.0f && a <= kGreatest)) {
          below = true;
          a = 0.0f;
        }
        a = std::min(a * units.scale, units.greatest);
      }
      if (below) ++here;
    }
    if (here > 0) negative += here;
  });
  return negative;
}

bool counts_needed(const RenderOptions& options) {
  return options.cache.candidates > 1 || has(options.aovs, Aov::training_count);
}

}  // namespace

CacheSession::CacheSession(const World& world, const Camera& camera, const PixelRect& region,
                           const RenderOptions& options, const CacheSetup* setup,
                           const std::function<void(const neural::Model&)>& expect_model,
                           RecordExchange exchange)
    : options_(options), exchange_(std::move(exchange)) {
  check_options(options);
  Clock::time_point start = Clock::now();
  if (setup) {
    setup_ = *setup;
  } else {
    const schedule::Section section("scout");
    Scouting scouting;
    Team::run([&](Team&) { scouting.add(world, camera, region, options, exchange_); });
    ScoutReport report = scouting.report(world.scene, options);
    setup_ = std::move(report.setup);
    scout_rays_ = report.rays;
  }
  statistics_.scout_seconds = seconds_since(start);
  start = Clock::now();

  const std::shared_ptr<const neural::Model> cache_model = make_cache_model(world, options, setup_);
  if (expect_model) expect_model(*cache_model);
  check_memory(world.scene, options, *cache_model);
  const bool chooses =
      options.cache.choose_device && !setup && exchange_.is_alone() && options.checkpoint.file.empty();
  trainer_ = std::make_unique<neural::Trainer>(
      cache_model, training_options(options),
      chooses ? choose_cache_backend(cache_model, options, statistics_.trial)
              : make_cache_backend(cache_model, options));
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
  const std::optional<DeviceTrial>& trial = statistics_.trial;
  statistics_.device = trial && device_is_faster(*trial) ? "vulkan:" + trial->device : options.cache.device;
  statistics_.setup_seconds = seconds_since(start);
  first_statistics_ = statistics_;
}

CacheSession::CacheSession(const World& world, const Camera& camera, const PixelRect& region,
                           const RenderOptions& options, CacheSession&& earlier, RecordExchange exchange)
    : options_(options),
      exchange_(std::move(exchange)),
      setup_(std::move(earlier.setup_)),
      trainer_(std::move(earlier.trainer_)),
      steps_(earlier.steps_),
      fits_(earlier.steps_ == 0),
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
  scene_ = &world.scene;
  dark_ = options_.integrator == Integrator::nrc && world.is_dark();
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

void CacheSession::start_anew(bool keeps_samples) {
  Snapshot start{{.setup = setup_}, first_statistics_, {}, scout_rays_, {}};
  start.state.model = neural::initial_state(model(), trainer_->options());
  start.state.triangle_counts.assign(counts_.values().size(), 0);
  if (keeps_samples) start.state.samples = samples_;
  return_to(start);
  fits_ = true;
}

std::uint64_t CacheSession::answer(const SurfacePoints& points, std::span<float> answers) const {
  return ask(options_.cache.bf16_queries ? neural::QueryPrecision::bf16 : neural::QueryPrecision::fp32,
             points, answers);
}

std::uint64_t CacheSession::ask(neural::QueryPrecision precision, const SurfacePoints& points,
                                std::span<float> answers) const {
  if (dark_) {
    std::fill(answers.begin(), answers.end(), 0.0f);
    return 0;
  }
  trainer_->query(points.batch(), {.precision = precision, .range = neural::OutputRange::raw}, answers);
  return convert_answers(records_->units(setup_), outputs(), answers);
}

void CacheSession::look_at_light(const RecordBatch& group) {
  std::vector<float> answers(group.records.size() * outputs());
  if (answers.empty()) return;
  trainer_->query(group.records.batch(), {.range = neural::OutputRange::raw}, answers);
  const double change = renderer::light_change(*scene_, group, answers, outputs());
  if (!light_change_) light_change_ = change;
  fits_ = change <= kUnchangedLight;
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
  return {export_state(), statistics_, exchange_.share, rays(), last_losses_};
}

void CacheSession::return_to(const Snapshot& snapshot) {
  import_state(snapshot.state);
  unlearned_rays_ = {};  // of training that ended with an exception
  RayCounts abandoned = rays();
  abandoned.subtract(snapshot.rays);
  abandoned_rays_.add(abandoned);
  statistics_ = snapshot.statistics;
  exchange_.share = snapshot.share;
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

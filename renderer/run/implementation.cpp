#include "renderer/run/implementation.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "neural/base/flush_denormals.h"
#include "renderer/cache/cache_backend.h"
#include "renderer/cache/cache_file.h"
#include "renderer/cache/cache_model.h"
#include "renderer/cache/cached_pass.h"
#include "renderer/film/camera_choice.h"
#include "renderer/film/memory_estimate.h"
#include "renderer/identity/deciding_options.h"
#include "renderer/machine/clock.h"
#include "renderer/machine/threads.h"
#include "renderer/settings/resolved_options.h"
#include "renderer/transport/reference_pass.h"

namespace gatelight::renderer {
namespace {

PixelRect resolve_region(const RenderOptions& options) {
  if (!options.region) return {0, 0, options.width, options.height};
  const auto& [x0, y0, x1, y1] = *options.region;
  if (x0 < 0 || y0 < 0 || x1 > options.width || y1 > options.height || x0 >= x1 || y0 >= y1) {
    throw BadOption(
        fmt::format("--region {},{},{},{}: expected x0,y0,x1,y1 within the picture of {}x{}, not empty", x0,
                    y0, x1, y1, options.width, options.height));
  }
  return {x0, y0, x1, y1};
}

std::size_t checked_budget(const scene::Scene& scene, const RenderOptions& options) {
  const MemoryEstimate need = estimate_memory(scene, options);
  require_memory(fmt::format("{}: rendering", scene.path), options, need.total(),
                 need.total() - need.geometry);
  if (options.memory_limit_bytes == 0) return 0;
  return options.memory_limit_bytes - (need.total() - need.bvh);
}

}  // namespace

Renderer::Implementation::Implementation(const scene::Scene& scene_in, const RenderOptions& options_in)
    : scene(scene_in),
      options(options_in),
      threads(options.threads > 0 ? options.threads : available_threads()),
      control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)),
      arena(threads),
      region(resolve_region(options)),
      tiles(region),
      view(choose_camera(scene, options.camera,
                         static_cast<float>(options.width) / static_cast<float>(options.height))),
      camera(view, options.width, options.height),
      filter(options.filter, options.filter_width),
      budget(checked_budget(scene, options)) {
  const neural::FlushDenormals flush;  // the arena's threads too, as it is made here
  require_threads(threads);
  const Clock::time_point start = Clock::now();
  // What was loaded has learned enough, unless the caller says otherwise.
  if (!options.cache.train_steps && options.cache.cache_in.empty()) {
    steps_chosen = true;
    options.cache.train_steps = choose_training_steps(
        options, static_cast<std::uint64_t>(region.width()) * static_cast<std::uint64_t>(region.height()));
  }
  arena.execute([&] {
    world.emplace(scene, options.environment, options.light_selection,
                  AccelOptions{threads, options.isa, budget});
  });
  if (!world->environment.warning().empty()) statistics.warnings.push_back(world->environment.warning());
  statistics.build_seconds = seconds_since(start);
  statistics.width = region.width();
  statistics.height = region.height();
  statistics.threads = threads;
  statistics.isa = world->accel.isa();
  statistics.geometry_bytes = scene::geometry_bytes(scene);
  statistics.bvh_bytes = world->accel.bytes();
  statistics.texture_bytes = world->textures.bytes() + world->environment.bytes();
  statistics.light_bytes = world->lights.bytes();
}

SceneFingerprint Renderer::Implementation::scene_fingerprint() {
  SceneFingerprint result;
  arena.execute([&] { result = compute_scene_fingerprint(scene, options.environment); });
  return result;
}

CheckpointIdentity Renderer::Implementation::identity(const SceneFingerprint& fingerprint) const {
  NamedTexts machine = {{"isa", world->accel.isa()}};
  if (uses_cache(options.integrator)) machine.push_back({"kernels", cache_machine(options)});
  return {deciding_options(options, view, machine), fingerprint, scene.instances.size()};
}

Training Renderer::Implementation::begin_training(Checkpoint* found, const SceneFingerprint& fingerprint,
                                                  const Callbacks& callbacks) {
  Training training;
  const std::string& file = options.cache.cache_in;
  const auto make_session = [&](const CacheSetup* setup, const auto& expect_model) {
    if (!setup && callbacks.progress) callbacks.progress({.phase = Phase::scout, .spp = options.spp});
    arena.execute([&] {
      training.session = std::make_unique<CacheSession>(*world, camera, region, options, setup, expect_model);
    });
  };
  if (found) {
    make_session(&found->cache_setup(),
                 [&](const neural::Model& model) { found->expect_model(model, training_options(options)); });
    training.session->import_state(found->read_cache(training.session->model(), training_options(options)));
    training.first_step = found->progress().first_step;
  } else if (!file.empty()) {
    CacheFile cache(file);
    cache.expect(meaning_of(options, resolve_ao_distance(options.ao_distance, scene.bounds)), fingerprint,
                 scene.instances.size());
    make_session(&cache.setup(),
                 [&](const neural::Model& model) { cache.expect_model(model, training_options(options)); });
    training.session->import_state(cache.read_state(training.session->model(), training_options(options)));
    training.first_step = training.session->steps();
  } else {
    make_session(nullptr, nullptr);
  }
  training.chosen = steps_chosen;
  training.steps = training.all_steps = options.cache.train_steps.value_or(0);
  training.complete = found && found->progress().phase == Phase::render;
  return training;
}

void Renderer::Implementation::train(Training& training, const Callbacks& callbacks,
                                     const std::function<void()>& after_group) {
  const CacheSession& session = *training.session;
  const auto first = static_cast<int>(training.first_step);
  double reported = -1.0;
  CacheSession::Watch watch;
  watch.stop = [&] { return training.stopped = callbacks.stop && callbacks.stop(); };
  watch.after_group = after_group;
  watch.progress = [&](int step, int, double loss) {
    const int done = step - first;
    const double now = session.statistics().train_seconds;
    if (!callbacks.progress || (done < training.all_steps && now - reported < 0.1)) return;
    reported = now;
    callbacks.progress({.phase = Phase::train,
                        .steps_done = done,
                        .steps = training.all_steps,
                        .loss = loss,
                        .spp = options.spp,
                        .fraction = static_cast<double>(done) / training.all_steps,
                        .seconds = now});
  };
  const std::uint64_t end = training.first_step + static_cast<std::uint64_t>(training.steps);
  arena.execute([&] { training.session->train(end, watch); });
  training.complete = !training.stopped || training.session->steps() >= end;
}

bool Renderer::Implementation::return_to_good(Training& training, Checkpoint* found,
                                              RenderStatistics& earlier, const Callbacks& callbacks) {
  CacheSession& session = *training.session;
  const std::uint64_t good = session.good_steps();
  const bool loaded = !options.cache.cache_in.empty();
  if (good == 0 && !loaded) return false;
  arena.execute([&] { session.start_anew(); });
  const neural::TrainingOptions learning = training_options(options);
  std::optional<CacheState> state;
  if (found) state = found->read_cache(session.model(), learning);
  if (!state || state->steps > good) {
    // A checkpoint may be later than the last good step: from the start, then.
    earlier = {};
    state.reset();
    if (loaded) state = CacheFile(options.cache.cache_in).read_state(session.model(), learning);
  }
  if (state) session.import_state(*state);
  training.all_steps = training.steps = static_cast<int>(good - std::min(good, training.first_step));
  if (good > session.steps()) train(training, callbacks, {});
  training.complete = !training.stopped;
  return true;
}

std::unique_ptr<Pass> Renderer::Implementation::make_pass(Training& training) {
  const PassContext context{tiles, options, camera, filter};
  if (training.session) return std::make_unique<CachedPass>(*world, context, *training.session);
  return std::make_unique<ReferencePass>(*world, context);
}

RenderStatistics Renderer::Implementation::sum_up(int spp, double seconds, const Pass* pass,
                                                  const Training& training,
                                                  const RenderStatistics& earlier) const {
  RenderStatistics sum = statistics;
  sum.render_seconds = seconds;
  sum.spp = spp;
  sum.samples = static_cast<std::uint64_t>(spp) * static_cast<std::uint64_t>(region.width()) *
                static_cast<std::uint64_t>(region.height());
  SampleCounts counts = pass ? pass->counts() : SampleCounts{};
  sum.rays = pass ? pass->rays() : RayCounts{};
  sum.nonfinite = counts.nonfinite;
  sum.clamped = counts.clamped;
  sum.nonfinite_samples = std::move(counts.located);
  if (training.session) {
    sum.rays.add(training.session->rays());
    sum.cache = training.session->statistics();
    sum.cache.steps_chosen = training.chosen;
    sum.cache.steps_wanted = training.steps;
    sum.cache.diverged = training.diverged;
    if (const auto* cached = dynamic_cast<const CachedPass*>(pass)) cached->add_to(sum.cache);
  }
  add_earlier(sum, earlier);
  return sum;
}

}  // namespace gatelight::renderer

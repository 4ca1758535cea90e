// A renderer's cache: loaded or new, trained, and returned to its last good state.

#include <algorithm>
#include <optional>

#include "renderer/cache/cache_file.h"
#include "renderer/cache/cache_model.h"
#include "renderer/distributed/packing.h"
#include "renderer/driver/implementation.h"
#include "renderer/driver/time_budget.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {
namespace {

/// A cache of less steps is worse than none, so a time limit leaves at least these.
constexpr std::uint64_t kLeastSteps = 16;

}  // namespace

Training Renderer::Implementation::begin_training(Checkpoint* found, const SceneFingerprint& fingerprint,
                                                  const Callbacks& callbacks) {
  Training training;
  const std::string& file = options.cache.cache_in;
  const auto make_session = [&](const CacheSetup* setup, const auto& expect_model) {
    if (!setup && callbacks.progress) callbacks.progress({.phase = Phase::scout, .spp = options.spp});
    arena.execute([&] {
      training.session =
          std::make_unique<CacheSession>(*world, camera, region, options, setup, expect_model, &rank_tiles);
    });
  };
  if (found) {
    make_session(&found->cache_setup(),
                 [&](const neural::Model& model) { found->expect_model(model, training_options(options)); });
    training.session->import_state(found->read_cache(training.session->model(), training_options(options)));
    training.first_step = found->progress().first_step;
  } else if (!file.empty()) {
    CacheFile cache(file);
    cache.expect({options, resolve_ao_distance(options.ao_distance, scene.bounds)}, fingerprint,
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

void Renderer::Implementation::train(Training& training, Film& film, const Callbacks& callbacks,
                                     const std::function<void()>& after_group) {
  const CacheSession& session = *training.session;
  const auto first = static_cast<int>(training.first_step);
  double reported = -1.0;
  CacheSession::Watch watch;
  const Clock::time_point start = Clock::now();
  const double end_seconds = std::chrono::duration<double>(training.end - start).count();
  const bool limited = training.end != Clock::time_point::max();
  double last_seconds = 0.0;
  std::uint64_t last_step = session.steps();
  watch.stop = [&] {
    training.stopped = any(ranks, callbacks.stop && callbacks.stop());
    if (training.stopped || !limited) return training.stopped;
    const double now = seconds_since(start);
    const std::uint64_t step = session.steps(), next = session.group_end(step) - step;
    const double seconds =
        (now - last_seconds) / static_cast<double>(std::max(step - last_step, std::uint64_t{1}));
    last_seconds = now;
    last_step = step;
    const bool late = !group_fits(now, seconds * static_cast<double>(next), end_seconds);
    return step >= training.first_step + kLeastSteps && agreed(ranks, late);
  };
  watch.rebalance = [&](const std::vector<RankWork>& work) { rebalance(film, work); };
  watch.after_group = after_group;
  if (training.first_step == 0)
    watch.samples = [&](const RecordBatch& group) {
      group.add_to(film, options, ranks.is_single() ? nullptr : &rank_tiles, training.counts);
    };
  watch.progress = [&](int step, int, double loss) {
    const int done = step - first;
    const double now = session.statistics().train_seconds;
    const double of_time = limited ? seconds_since(start) / std::max(end_seconds, 1e-9) : 0.0;
    if (!callbacks.progress || (done < training.all_steps && now - reported < 0.1)) return;
    reported = now;
    callbacks.progress({.phase = Phase::train,
                        .steps_done = done,
                        .steps = training.all_steps,
                        .loss = loss,
                        .spp = options.spp,
                        .fraction = std::clamp(of_time, static_cast<double>(done) / training.all_steps, 1.0),
                        .seconds = now});
  };
  const std::uint64_t wanted = training.first_step + static_cast<std::uint64_t>(training.steps);
  arena.execute([&] { training.session->train(wanted, watch); });
  training.complete = !training.stopped || training.session->steps() >= wanted;
  if (limited && !training.stopped) training.steps = static_cast<int>(session.steps() - training.first_step);
}

bool Renderer::Implementation::return_to_good(Training& training, Film& film, Checkpoint* found,
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
    // A checkpoint may be later than the last good step: training then starts again.
    earlier = {};
    state.reset();
    if (loaded) state = CacheFile(options.cache.cache_in).read_state(session.model(), learning);
  }
  film = make_film();
  training.counts = {};
  if (state) {
    session.import_state(*state);
    if (found && state->steps > 0) found->restore(film, earlier);
  }
  training.all_steps = training.steps = static_cast<int>(good - std::min(good, training.first_step));
  training.end = Clock::time_point::max();
  if (good > session.steps()) train(training, film, callbacks, {});
  training.complete = !training.stopped;
  return true;
}

}  // namespace gatelight::renderer

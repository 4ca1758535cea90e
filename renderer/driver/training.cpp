#include "renderer/driver/training.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "renderer/cache/cache_file.h"
#include "renderer/cache/cache_model.h"
#include "renderer/driver/cache_sessions.h"
#include "renderer/driver/time_budget.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {
namespace {

/// A cache of less steps is worse than none, so a time limit leaves at least these.
constexpr std::uint64_t kMinSteps = 16;

/// Each frame of an animation trains this share of the steps of a cache that knows nothing, and at least
/// these. Their paths are samples of the picture, and what is learned adds up over the frames (README.md).
constexpr int kShareOfFresh = 2;
constexpr int kMinKept = 32;
/// After a change of the light the optimiser learns as fast as after so many steps.
constexpr std::uint32_t kMemoryAfterChange = 32;

}  // namespace

Training::Training(const RenderContext& context, Checkpoint* found)
    : context_(context),
      options_(context.picture.options),
      found_(found),
      steps_(options_.cache.train_steps.value_or(0)),
      all_steps_(steps_),
      steps_chosen_(context.picture.steps_chosen) {
  const PreparedPicture& picture = context.picture;
  const CacheOptions& cache = options_.cache;
  if (!cache.cache_in.empty() || !cache.cache_out.empty()) fingerprint_ = picture.fingerprint();
  if (found) {
    const neural::TrainingOptions learning = training_options(options_);
    session_ = make_session(picture, context.team.records(), &found->cache_setup(),
                            [&](const neural::Model& model) { found->expect_model(model, learning); });
    session_->import_state(found->read_cache(session_->model(), learning));
    first_step_ = found->progress().first_step;
    complete_ = found->progress().phase == Phase::render;
  } else if (!cache.cache_in.empty()) {
    session_ = read_session(picture, context.team.records(), cache.cache_in, fingerprint_);
    first_step_ = session_->steps();
  } else {
    if (context.callbacks.progress) context.callbacks.progress({.phase = Phase::scout, .spp = options_.spp});
    session_ = make_session(picture, context.team.records(), nullptr);
  }
}

Training::Training(const RenderContext& context, FrameMemory& memory)
    : context_(context),
      options_(context.picture.options),
      found_(nullptr),
      steps_(memory.fresh_steps),
      all_steps_(steps_),
      steps_chosen_(true),
      fresh_steps_(memory.fresh_steps) {
  const PreparedPicture& picture = context.picture;
  picture.arena.execute([&] {
    session_ = std::make_unique<CacheSession>(*picture.world, picture.camera, picture.region, options_,
                                              std::move(*memory.cache), context.team.records());
  });
  memory.cache.reset();
  first_step_ = session_->steps();
}

void Training::release_to(FrameMemory& memory) {
  if (!complete_ && !stopped_) session_->start_anew();  // it has diverged
  memory.cache = std::move(session_);
}

void Training::expect_steps(int steps) {
  all_steps_ = steps;
  steps_chosen_ = false;
}

void Training::train(int steps, Film& film, const std::function<void()>& after_group) {
  PictureTeam& team = context_.team;
  const Clock::time_point start = Clock::now();
  const bool limited = end_ != Clock::time_point::max();
  const double end = std::chrono::duration<double>(end_ - start).count();
  double last_seconds = 0.0, reported = -1.0;
  std::uint64_t last_step = session_->steps();
  CacheSession::Watch watch;
  watch.stop = [&] {
    if (context_.callbacks.abandon && context_.callbacks.abandon()) {
      stopped_ = true;  // what was learned stays
      throw Abandoned();
    }
    stopped_ = team.any(context_.callbacks.stop && context_.callbacks.stop());
    if (stopped_ || !limited) return stopped_;
    const double now = seconds_since(start);
    const std::uint64_t step = session_->steps(), next = session_->group_end(step) - step;
    const double seconds =
        (now - last_seconds) / static_cast<double>(std::max(step - last_step, std::uint64_t{1}));
    last_seconds = now;
    last_step = step;
    const bool late = !group_fits(now, seconds * static_cast<double>(next), end);
    return step >= first_step_ + kMinSteps && team.agreed(late);
  };
  watch.rebalance = [&](const std::vector<RankWork>& work) { team.rebalance(film, work); };
  watch.after_group = after_group;
  if (makes_samples())
    watch.samples = [&](const RecordBatch& group) {
      const auto owned = [&](const Pixel& pixel) { return session_->exchange().owns(pixel); };
      group.add_to(film, options_, owned, counts_);
    };
  watch.progress = [&](int step, int, double loss) {
    const double now = session_->statistics().train_seconds;
    const int done = step - static_cast<int>(first_step_);
    if (done < all_steps_ && now - reported < 0.1) return;
    reported = now;
    report(done, loss, limited ? seconds_since(start) / std::max(end, 1e-9) : 0.0);
  };
  const std::uint64_t wanted = first_step_ + static_cast<std::uint64_t>(steps);
  context_.picture.arena.execute([&] { session_->train(wanted, watch); });
  complete_ = !stopped_ || session_->steps() >= wanted;
  const bool ended_by_time = limited && !stopped_;
  steps_ = ended_by_time ? static_cast<int>(session_->steps() - first_step_) : steps;
}

void Training::train_on(Film& film, FrameMemory& memory) {
  if (options_.integrator == Integrator::nrc && context_.picture.world->is_dark()) {
    memory.history.reset();
    complete_ = true;  // what the cache knows is for the time when the lamps are on again
    return;
  }
  if (first_step_ == 0) return train(fresh_steps_, film);
  const auto first_group = static_cast<int>(session_->group_end(first_step_) - first_step_);
  train(std::min(first_group, fresh_steps_), film);
  if (stopped_) return;
  const double change = session_->light_change();
  if (begins_anew(change)) {
    memory.history.reset();
    session_->start_anew(true);
    first_step_ = 0;
    return train(fresh_steps_, film);
  }
  const int usual = std::min(std::max(fresh_steps_ / kShareOfFresh, kMinKept), fresh_steps_);
  const int more = steps_after_change(change, fresh_steps_ - usual);
  if (more > 0) session_->forget_beyond(kMemoryAfterChange);
  train(usual + more, film);
}

void Training::report(int done, double loss, double of_time) const {
  if (!context_.callbacks.progress) return;
  context_.callbacks.progress({.phase = Phase::train,
                               .steps_done = done,
                               .steps = all_steps_,
                               .loss = loss,
                               .spp = options_.spp,
                               .fraction = std::clamp(of_time, static_cast<double>(done) / all_steps_, 1.0),
                               .seconds = session_->statistics().train_seconds});
}

bool Training::roll_back(const std::string& reason, Film& film, RenderStatistics& earlier) {
  const std::uint64_t good = session_->good_steps();
  const bool loaded = !options_.cache.cache_in.empty();
  if (good == 0 && !loaded) return false;
  context_.picture.arena.execute([&] { session_->start_anew(); });
  const neural::TrainingOptions learning = training_options(options_);
  std::optional<CacheState> state;
  if (found_) state = found_->read_cache(session_->model(), learning);
  if (!state || state->steps > good) {
    // A checkpoint may be later than the last good step: training then starts again.
    earlier = {};
    state.reset();
    if (loaded) state = CacheFile(options_.cache.cache_in).read_state(session_->model(), learning);
  }
  film = context_.picture.make_film();
  counts_ = {};
  if (state) {
    session_->import_state(*state);
    if (found_ && state->steps > 0) found_->restore(film, earlier);
  }
  all_steps_ = steps_ = static_cast<int>(good - std::min(good, first_step_));
  end_ = Clock::time_point::max();
  if (good > session_->steps()) train(steps_, film);
  complete_ = !stopped_;
  diverged_ = reason;
  return true;
}

void Training::return_to(Snapshot snapshot) {
  session_->return_to(snapshot.session);
  counts_ = std::move(snapshot.counts);
}

void Training::add_to(RenderStatistics& statistics) const {
  statistics.rays.add(session_->rays());
  statistics.cache = session_->statistics();
  statistics.cache.steps_chosen = steps_chosen_;
  statistics.cache.steps_wanted = steps_;
  statistics.cache.light_change = session_->light_change();
  statistics.cache.diverged = diverged_;
}

void Training::write_cache() const {
  write_cache_file(options_.cache.cache_out, session_->export_state(), session_->model(),
                   training_options(options_), context_.picture.cache_meaning(), fingerprint_);
}

}  // namespace gatelight::renderer

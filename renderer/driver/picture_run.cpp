#include "renderer/driver/picture_run.h"

#include <tbb/task_group.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/clock.h"
#include "base/errors.h"
#include "base/file/atomic_file.h"
#include "base/parallel/schedule.h"
#include "renderer/driver/error_checks.h"
#include "renderer/driver/picture_checkpoint.h"
#include "renderer/driver/picture_stages.h"
#include "renderer/driver/picture_statistics.h"
#include "renderer/driver/sample_loop.h"
#include "renderer/driver/time_budget.h"
#include "renderer/driver/training.h"

namespace gatelight::renderer {
namespace {

/// One picture from start to end.
class PictureRun {
 public:
  PictureRun(const RenderContext& context, RenderStatistics& statistics, FrameMemory* memory)
      : context_(context),
        memory_(memory),
        options_(context.picture.options),
        team_(context.team),
        statistics_(statistics),
        sums_(context),
        film_(context.picture.make_film()) {}

  ~PictureRun() {
    context_.picture.arena.execute([&] { beside_.wait(); });
    if (memory_ && training_) training_->release_to(*memory_);
  }

  Picture make() {
    restore();
    plan();
    train();
    write_cache();
    SampleLoop loop(context_, film_, training_.get(), options_.spp);
    run_passes(loop);
    end_passes(loop);
    Picture picture = finish_film(loop, memory_);
    add_cryptomattes(picture, std::move(mattes_));
    note_end(loop);
    return picture;
  }

 private:
  void restore() {
    const std::string& cache = options_.cache.cache_out;
    if (uses_cache(options_.integrator) && !cache.empty()) check_output(context_, cache);
    checkpoint_.emplace(context_, film_, sums_.earlier);
  }

  /// Work whose time does not depend on the picture's samples comes first, so that a time limit includes it.
  void plan() {
    const schedule::Section section("plan");
    mattes_ = make_cryptomattes(context_, sums_.cryptomatte_seconds);
    budget_.limit = options_.time_limit_seconds;
    if (budget_.limit > 0.0) budget_.finish = expect_finish_seconds(context_);
  }

  Clock::time_point time_at(double seconds) const {
    constexpr double kMax = 1e9;  // a clock counts some centuries at most
    const std::chrono::duration<double> after(std::min(seconds, kMax));
    return sums_.begin + std::chrono::duration_cast<Clock::duration>(after);
  }

  void train() {
    if (!uses_cache(options_.integrator)) return;
    const schedule::Section section("cache");
    if (memory_) {
      training_ = std::make_unique<Training>(context_, *memory_);
      return training_->train_on(film_, *memory_);
    }
    training_ = std::make_unique<Training>(context_, checkpoint_->found());
    if (training_->complete()) return;
    if (budget_.limit > 0.0) {
      const bool samples = options_.cache.source == TrainingSource::picture;
      training_->end_at(time_at(budget_.training_end(seconds_since(sums_.begin), samples)));
    }
    try {
      training_->train(options_.cache.train_steps.value_or(0), film_, [&] {
        if (!checkpoint_->is_due()) return;
        training_->session().synchronize();
        keep(Phase::train, 0, sum_up(nullptr), true);
      });
    } catch (const TrainingDiverged& error) {
      // The last good state still gives a picture and a cache file. The checkpoint is kept.
      if (!training_->roll_back(error.what(), film_, sums_.earlier)) throw;
      checkpoint_->close();
    }
    // Training that a time limit ended is not repeated: its end decides the picture.
    keep(is_converged_cache() ? Phase::render : Phase::train, 0, sum_up(nullptr), is_converged_cache());
  }

  void write_cache() const {
    if (training_ && is_converged_cache() && !options_.cache.cache_out.empty())
      write_output(context_, false, [&] { training_->write_cache(); });
  }

  void run_passes(SampleLoop& loop) {
    const schedule::Section section("passes");
    loop.begin_at(sums_.earlier.spp);
    limit_passes(loop);
    if (training_ && training_->stopped()) loop.stop();
    if (is_good_enough(loop)) return;
    context_.picture.arena.execute([&] { beside_.run([&] { prepare_to_finish(context_.picture); }); });
    while (loop.done() < options_.spp) {
      if (!run_pass(loop) || loop.done() == options_.spp) return;
      limit_passes(loop);
      show_snapshot(loop);
      if (loop.over() || is_good_enough(loop) || loop.over()) return;
      team_.rebalance(film_, loop.last_pass());
      if (is_converged_cache() && checkpoint_->is_due())
        keep(Phase::render, loop.done(), sum_up(&loop), true);
    }
  }

  /// False where the device was lost.
  bool run_pass(SampleLoop& loop) {
    int goal = options_.spp;
    if (options_.max_error > 0.0) goal = std::min(goal, next_check(loop.done()));
    try {
      loop.run_pass(goal);
      return true;
    } catch (const DeviceLost& error) {
      // Each pixel is the mean of its own samples, so an incomplete pass is a picture. A checkpoint could
      // not resume from it; the last checkpoint is kept.
      if (loop.done() == 0 || !team_.is_alone()) throw;
      device_lost_ = error.what();
      return false;
    }
  }

  void limit_passes(SampleLoop& loop) {
    if (budget_.limit <= 0.0) return;
    // A checkpoint holds whole passes.
    loop.end_at(time_at(budget_.passes_end()), !checkpoint_->is_kept());
  }

  void show_snapshot(SampleLoop& loop) {
    const Callbacks& callbacks = context_.callbacks;
    const bool wanted = callbacks.snapshot_wanted && callbacks.snapshot && callbacks.snapshot_wanted();
    if (!team_.any(wanted)) return;
    statistics_ = sum_up(&loop);
    Picture picture = finish_film(loop, nullptr);
    if (!team_.finishes()) return;
    add_cryptomattes(picture, mattes_);
    callbacks.snapshot(picture);
  }

  /// Estimates the error where it is time to.
  bool is_good_enough(SampleLoop& loop) {
    if (options_.max_error <= 0.0 || !is_check(loop.done())) return false;
    const Clock::time_point start = Clock::now();
    const std::optional<double> error = estimate_error(context_, film_);
    loop.leave_out(seconds_since(start));
    if (!error) return false;
    const double times = *error / options_.max_error;
    loop.report_error(*error, loop.done() * times * times);
    return reached_error_ = *error <= options_.max_error;
  }

  void end_passes(const SampleLoop& loop) {
    statistics_ = sum_up(&loop);
    statistics_.device_lost = device_lost_;
    if (is_converged_cache() && device_lost_.empty()) keep(Phase::render, loop.done(), statistics_, false);
    loop.report_end();
  }

  /// The picture of the film, with its statistics.
  Picture finish_film(const SampleLoop& loop, FrameMemory* memory) {
    const schedule::Section section("finish");
    FinishedPicture finished = finish(context_, film_, loop.stopped(), statistics_, memory);
    denoising_stopped_ = finished.stopped;
    return std::move(finished.picture);
  }

  /// Stores the cause of the picture's end. Its error is known by now.
  void note_end(const SampleLoop& loop) {
    const bool all_samples = loop.done() >= options_.spp;
    if (!device_lost_.empty()) {
      statistics_.ended_by = EndedBy::device;
    } else if (denoising_stopped_ || (loop.stopped() && !(all_samples && is_converged_cache()))) {
      statistics_.ended_by = EndedBy::caller;
    } else if (reached_error_) {
      statistics_.ended_by = EndedBy::max_error;
    } else {
      statistics_.ended_by = all_samples ? EndedBy::spp : EndedBy::time_limit;
    }
    const bool early = statistics_.ended_by != EndedBy::max_error && !all_samples;
    statistics_.interrupted = early || !is_converged_cache() || denoising_stopped_;
  }

  /// A picture from an incomplete cache is a preview; it is never resumed.
  bool is_converged_cache() const { return !training_ || training_->complete(); }
  RenderStatistics sum_up(const SampleLoop* loop) const { return sums_.sum_up(film_, training_.get(), loop); }
  void keep(Phase phase, int samples, const RenderStatistics& sum, bool again) {
    checkpoint_->write(phase, samples, film_, training_.get(), sum, again);
  }

  RenderContext context_;
  FrameMemory* memory_;
  const RenderOptions& options_;
  PictureTeam& team_;
  RenderStatistics& statistics_;  ///< of the picture so far
  PictureStatistics sums_;
  Film film_;
  std::optional<PictureCheckpoint> checkpoint_;
  TimeBudget budget_;
  tbb::task_group beside_;  ///< work for a thread that is free
  Cryptomattes mattes_;
  std::unique_ptr<Training> training_;  ///< null without a cache
  std::string device_lost_;             ///< why, where that ended the passes
  bool reached_error_ = false;          ///< max_error ended the passes
  bool denoising_stopped_ = false;
};

}  // namespace

Picture render_picture(const RenderContext& context, RenderStatistics& statistics, FrameMemory* memory) {
  return PictureRun(context, statistics, memory).make();
}

}  // namespace gatelight::renderer

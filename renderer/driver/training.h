#pragma once
// The cache of a picture, in training.

#include <functional>
#include <memory>
#include <string>

#include "base/clock.h"
#include "renderer/cache/cache_session.h"
#include "renderer/driver/checkpoint.h"
#include "renderer/driver/frame_memory.h"
#include "renderer/driver/render_context.h"

namespace gatelight::renderer {

class Training {
 public:
  /// Starts from the checkpoint or the cache file where there is one, else from a new cache, and scouts.
  /// `found`: the checkpoint, which outlives the training; null: none.
  Training(const RenderContext& context, Checkpoint* found);
  /// Goes on with the cache of an animation, which memory gets back from release_to().
  Training(const RenderContext& context, FrameMemory& memory);
  void release_to(FrameMemory& memory);

  /// Training should end here, with a group of steps.
  void end_at(Clock::time_point end) { end_ = end; }
  /// The steps of the last picture of a series, which progress reports. Without a call the options give them.
  void expect_steps(int steps);
  /// Trains up to `steps`, which do not count those of a loaded cache. The film gets the paths that are
  /// samples of the picture. Throws TrainingDiverged.
  void train(int steps, Film& film, const std::function<void()>& after_group = {});
  /// Trains a kept cache by a few steps, and by more where its light has changed. Where it begins anew, the
  /// light of earlier frames is dropped from `memory`, too.
  void train_on(Film& film, FrameMemory& memory);
  /// After training diverged: returns to the last good state by training up to it again. So normal training
  /// costs nothing extra. False where there is no good state. Film and `earlier` are those of that state.
  bool roll_back(const std::string& reason, Film& film, RenderStatistics& earlier);

  struct Snapshot {
    CacheSession::Snapshot session;
    SampleCounts counts;
  };
  Snapshot snapshot() const { return {session_->snapshot(), counts_}; }
  void return_to(Snapshot snapshot);

  CacheSession& session() const { return *session_; }
  /// Steps of a loaded cache come before this one.
  std::uint64_t first_step() const { return first_step_; }
  bool complete() const { return complete_; }
  /// Whether the caller stopped it.
  bool stopped() const { return stopped_; }
  /// Whether the film has samples from training. A loaded cache was trained with another picture.
  bool has_training_samples() const { return makes_samples() && session_->samples() > 0; }
  /// The picture's samples that trained the cache, in this run.
  const SampleCounts& counts() const { return counts_; }
  /// Rays and statistics of the cache.
  void add_to(RenderStatistics& statistics) const;

  /// Writes `cache_out`. Throws OutputError.
  void write_cache() const;

 private:
  bool makes_samples() const { return first_step_ == 0 || fresh_steps_ > 0; }
  /// `of_time`: the share of its time that is over; 0 without a limit.
  void report(int done, double loss, double of_time) const;

  RenderContext context_;
  const RenderOptions& options_;
  Checkpoint* found_;
  SceneFingerprint fingerprint_;  ///< for a cache file
  std::unique_ptr<CacheSession> session_;
  std::uint64_t first_step_ = 0;
  int steps_;      ///< wanted for the next picture
  int all_steps_;  ///< wanted for the last one
  bool steps_chosen_;
  bool complete_ = false;
  bool stopped_ = false;
  Clock::time_point end_ = Clock::time_point::max();
  int fresh_steps_ = 0;   ///< in an animation: FrameMemory::fresh_steps
  std::string diverged_;  ///< why training returned to its last good state; else empty
  SampleCounts counts_;
};

}  // namespace gatelight::renderer

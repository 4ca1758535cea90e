#pragma once
// The checkpoint file of a picture that is being made: resumed from, and written when due.

#include <functional>
#include <optional>
#include <string>

#include "base/clock.h"
#include "renderer/driver/checkpoint.h"
#include "renderer/driver/render_context.h"
#include "renderer/driver/training.h"

namespace gatelight::renderer {

/// Calls `write` where this process writes files. A full disk, or too little memory for a copy of the state,
/// costs the file but not the picture. `again`: another try follows.
void write_output(const RenderContext& context, bool again, const std::function<void()>& write);
/// Throws OutputError where this process writes files, and this one cannot be written.
void check_output(const RenderContext& context, const std::string& file);

/// Without CheckpointOptions::file nothing is read or written.
class PictureCheckpoint {
 public:
  /// Reads the file where the options ask to resume from it. Film and `earlier` are then its.
  PictureCheckpoint(const RenderContext& context, Film& film, RenderStatistics& earlier);

  /// Null: the picture was not resumed.
  Checkpoint* found() { return found_ ? &*found_ : nullptr; }
  bool is_kept() const { return identity_.has_value(); }
  bool is_due() const;
  /// Writes where it is kept. `samples`: of the film's pixels. `training`: null without a cache.
  void write(Phase phase, int samples, Film& film, const Training* training, const RenderStatistics& sum,
             bool again);
  /// Writes no more: the last file stays.
  void close() { identity_.reset(); }

 private:
  RenderContext context_;
  const CheckpointOptions& options_;
  std::optional<CheckpointIdentity> identity_;  ///< empty: none is written
  SharedFile shared_;
  std::optional<Checkpoint> found_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace gatelight::renderer

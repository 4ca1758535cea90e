#pragma once
// The checkpoint of one picture: found when it is begun, written while it is made.

#include <chrono>
#include <optional>

#include "renderer/cache/cache_session.h"
#include "renderer/run/checkpoint.h"

namespace gatelight::renderer {

class CheckpointKeeper {
 public:
  /// options.file is not empty. Throws OutputError where it could not be written.
  CheckpointKeeper(const CheckpointOptions& options, CheckpointIdentity identity);

  /// The one to go on with: where that is asked for and the file is there. Throws neural::CacheFileError
  /// where it is of another picture, damaged, or has more than `spp` samples.
  std::optional<Checkpoint> find(int spp) const;

  /// Whether enough time has passed since the last one.
  bool due() const;
  /// `session` may be null, `training` are the options of its model. Throws OutputError.
  void write(const CheckpointProgress& progress, const RenderStatistics& statistics, const Film& film,
             const CacheSession* session, const neural::TrainingOptions& training);

 private:
  CheckpointOptions options_;
  CheckpointIdentity identity_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace gatelight::renderer

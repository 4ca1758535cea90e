#pragma once
// All that is needed to resume a picture, in one file: the film's sums, the statistics, and the cache with
// its optimiser.

#include <filesystem>
#include <optional>

#include "base/file/safetensors.h"
#include "renderer/cache/cache_state.h"
#include "renderer/film/film.h"
#include "renderer/fingerprint/scene_fingerprint.h"
#include "renderer/render.h"

namespace gatelight::renderer {

/// Properties that a picture must share with a checkpoint that it resumes.
struct CheckpointIdentity {
  NamedTexts options;  ///< deciding_options()
  SceneFingerprint scene;
  std::size_t instances = 0;  ///< of the scene
};

struct CheckpointProgress {
  Phase phase = Phase::render;  ///< train or render
  int samples = 0;              ///< of the passes; 0 while it trains
  std::uint64_t first_step =
      0;  ///< number of its first training step; the steps of a loaded cache come before
  bool has_training_samples = false;  ///< the film has samples of training
};

/// Adds the statistics of earlier runs of the same picture.
void add_earlier(RenderStatistics& statistics, const RenderStatistics& earlier);

/// A cache, and the data that is needed to write it.
struct CheckpointCache {
  const CacheState& state;
  const neural::Model& model;
  const neural::TrainingOptions& options;
};

/// Writes a checkpoint atomically: whenever the program ends, the old or the new file is there. Throws
/// OutputError.
void write_checkpoint(const std::filesystem::path& path, const CheckpointIdentity& identity,
                      const CheckpointProgress& progress, const RenderStatistics& statistics,
                      const Film& film, const std::optional<CheckpointCache>& cache);

/// A checkpoint whose digest has been checked. All members throw CacheFileError, which names the
/// file, the value and what was expected.
class Checkpoint {
 public:
  explicit Checkpoint(const std::filesystem::path& path);

  const CheckpointProgress& progress() const { return progress_; }
  bool has_cache() const { return cache_setup_.has_value(); }
  /// The model is built from it. Throws where there is no cache.
  const CacheSetup& cache_setup() const;

  /// Throws, naming what differs, for other options, another scene, or more samples than `spp`.
  void expect(const CheckpointIdentity& identity, int spp) const;
  /// Sets the film and the statistics that count over the whole picture.
  void restore(Film& film, RenderStatistics& statistics);
  /// Throws where the tensors are not of this model. Call it before memory for them is allocated.
  void expect_model(const neural::Model& model, const neural::TrainingOptions& options) const;
  /// Throws where there is no cache.
  CacheState read_cache(const neural::Model& model, const neural::TrainingOptions& options);

 private:
  SafetensorsReader file_;
  CheckpointProgress progress_;
  std::optional<CacheSetup> cache_setup_;
};

}  // namespace gatelight::renderer

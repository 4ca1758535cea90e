#pragma once
// The state of a cache: the setup, which is fixed before the first step, and the results of training.
// Checkpoints and cache files store it.

#include <cstdint>
#include <vector>

#include "neural/layout/surface_layout.h"
#include "neural/model/state.h"
#include "renderer/cache/training_guard.h"

namespace gatelight::renderer {

/// At most 64 paths are traced for one record.
inline constexpr float kMinRecordsPerPath = 1.0f / 64.0f;

/// Results of scouting. They decide the layout of the features and the scale of targets.
struct CacheSetup {
  std::vector<neural::Sides> sides;     ///< which sides of each instance of the scene have storage
  float node_spacing = 0.1f;            ///< metres; of the layout before any memory budget
  std::vector<float> spacing_scales;    ///< for each instance: its spacing over node_spacing
  float target_scale = 1.0f;            ///< targets are radiance times this
  float records_per_path = 1.0f;        ///< of paths that run to their end
  float records_per_short_path = 1.0f;  ///< of paths that end in the cache's answer
};

struct CacheState {
  CacheSetup setup;
  neural::ModelState model;
  std::uint64_t steps = 0;    ///< of this training; keys the next step's random numbers
  std::uint64_t samples = 0;  ///< of the picture, used in training; the next ones follow in SampleOrder
  /// For each triangle with storage: steps that trained it or, where candidates are compared, that began a
  /// path there. Empty unless counted.
  std::vector<std::uint32_t> triangle_counts;
  TrainingGuard guard;  ///< only in checkpoints: other training has another camera, batch or loss
};

}  // namespace gatelight::renderer

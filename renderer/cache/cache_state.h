#pragma once
// All of a cache that is not an option: what was decided before the first step, and what training has
// changed. Checkpoints and cache files hold it.

#include <cstdint>
#include <vector>

#include "neural/layout/surface_layout.h"
#include "neural/model/state.h"
#include "renderer/cache/training_guard.h"

namespace gatelight::renderer {

/// Not more than 64 paths are traced for one record.
inline constexpr float kLeastRecordsPerPath = 1.0f / 64.0f;

/// Found by the scouting paths; decides the layout of the features and the scale of targets.
struct CacheSetup {
  std::vector<neural::Sides> sides;     ///< which sides of each instance of the scene have storage
  float node_spacing = 0.1f;            ///< metres; of the layout before any memory budget
  std::vector<float> spacing_scales;    ///< for each instance: its node spacing over that one
  float target_scale = 1.0f;            ///< targets are radiance times this
  float records_per_path = 1.0f;        ///< of paths that run to their end
  float records_per_short_path = 1.0f;  ///< of paths that end in the cache's answer
};

struct CacheState {
  CacheSetup setup;
  neural::ModelState model;
  std::uint64_t steps = 0;  ///< of this training: keys of the next step's random numbers
  /// Steps that trained each triangle with storage, or, where candidates are compared, began a path there;
  /// empty unless counted.
  std::vector<std::uint32_t> triangle_counts;
  TrainingGuard guard;  ///< in checkpoints alone: further training has another camera, batch or loss
};

}  // namespace gatelight::renderer

#pragma once
// Detects training that diverges.

#include <cstddef>
#include <cstdint>
#include <span>

#include "neural/trainer.h"

namespace gatelight::renderer {

/// Running statistics of training. Both functions throw TrainingDiverged.
struct TrainingGuard {
  double loss_average = 0.0;  ///< slow running mean of the loss
  double loss_least = 0.0;    ///< least value of loss_average
  std::uint64_t steps = 0;    ///< passed to look_at_loss()
  double group_loss = 0.0;    ///< sum over the steps since look_at_answers()
  std::uint64_t group_steps = 0;
  double brightest = 1.0;        ///< greatest mean magnitude of a group's targets
  std::uint64_t good_steps = 0;  ///< CacheState::steps of the last good state; 0: none
  friend bool operator==(const TrainingGuard&, const TrainingGuard&) = default;

  /// Call it after each step. Throws for a loss that is not finite and for losses that grow without bound.
  void look_at_loss(const neural::StepStatistics& step, std::uint64_t number);
  /// Largest number of points that look_at_answers() queries.
  static constexpr std::size_t kLookedAt = 1024;
  /// Call it between groups, after `steps_done` steps. Throws for losses and answers that only diverged
  /// training reaches. `targets` are those of the group, `some` are some of its points.
  void look_at_answers(std::span<const float> targets, const neural::QueryBatch& some,
                       const neural::Trainer& trainer, std::uint64_t steps_done);
};

}  // namespace gatelight::renderer

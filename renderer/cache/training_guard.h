#pragma once
// Notices a training that diverges.

#include <cstddef>
#include <cstdint>
#include <span>

#include "neural/trainer.h"

namespace gatelight::renderer {

/// What training has shown so far. Both functions throw TrainingDiverged.
struct TrainingGuard {
  double loss_average = 0.0;  ///< a slow mean
  double loss_least = 0.0;    ///< that it has had
  std::uint64_t steps = 0;    ///< looked at
  double group_loss = 0.0;    ///< sum over the steps since answers were looked at
  std::uint64_t group_steps = 0;
  double brightest = 1.0;        ///< greatest mean magnitude of a group's targets
  std::uint64_t good_steps = 0;  ///< CacheState::steps when training was last as good as ever; 0: never
  friend bool operator==(const TrainingGuard&, const TrainingGuard&) = default;

  /// Called after each step: refuses a loss that is not finite, and losses that grow without end.
  void look_at_loss(const neural::StepStatistics& step, std::uint64_t number);
  /// The most points that are asked.
  static constexpr std::size_t kLookedAt = 1024;
  /// Called between groups, after `steps_done` steps: refuses losses and answers that no training reaches.
  /// `targets` are those of the group, `some` are points of it.
  void look_at_answers(std::span<const float> targets, const neural::QueryBatch& some,
                       const neural::Trainer& trainer, std::uint64_t steps_done);
};

}  // namespace gatelight::renderer

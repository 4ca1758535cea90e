#include "renderer/cache/training_guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/errors.h"
#include "base/parallel/loops.h"
#include "neural/learning/record_status.h"

namespace gatelight::renderer {
namespace {

// Training has diverged when a running mean of the loss is ten times its least value. Single bright records
// raise one step's loss a thousandfold; so the mean is slow, and a step counts for at most ten times the
// mean. Losses below kFloor may vary freely.
constexpr double kDecay = 0.995;
/// First step of this run that is checked: another camera or batch has another loss.
constexpr std::uint64_t kFirstLooked = 200;
constexpr double kFactor = 10.0;
constexpr double kFloor = 1e-2;

// Bounds that only diverged training exceeds, checked between groups: answers 100 times as bright as any
// group's targets, and a loss 130 times that of the constant answer 1. (Answers of zero where rare light of t
// arrives reach 101 t^2 / (t - 1)^2, as the relative loss divides by 0.01.) The loss by itself is not enough:
// the relative loss tends to one for unbounded answers.
constexpr double kGreatestBrightness = 100.0;
constexpr double kGreatestLoss = 130.0;
/// A state is good where the running mean is within this factor of its least value, and the group's mean
/// within this factor of the running mean.
constexpr double kGoodAverage = 1.25;
constexpr double kGoodGroup = 2.0;

}  // namespace

void TrainingGuard::look_at_loss(const neural::StepStatistics& step, std::uint64_t number) {
  if (step.records == 0) return;
  if (!std::isfinite(step.loss))
    throw TrainingDiverged(fmt::format("training step {}: the loss is not finite", number));
  group_loss += step.loss;
  ++group_steps;
  const double fed = loss_average > 0.0 ? std::min(step.loss, kFactor * loss_average) : step.loss;
  loss_average = loss_average > 0.0 ? loss_average + (1.0 - kDecay) * (fed - loss_average) : fed;
  if (++steps < kFirstLooked) {
    loss_least = loss_average;
    return;
  }
  loss_least = std::min(loss_least, loss_average);
  if (loss_average > kFactor * std::max(loss_least, kFloor)) {
    throw TrainingDiverged(fmt::format("training step {}: the loss grew from {:.3g} to {:.3g}", number,
                                       loss_least, loss_average));
  }
}

void TrainingGuard::look_at_answers(std::span<const float> targets, const neural::QueryBatch& some,
                                    const neural::Trainer& trainer, std::uint64_t steps_done) {
  if (group_steps == 0 || some.size == 0) return;
  const double loss = group_loss / static_cast<double>(group_steps);
  group_loss = 0.0;
  group_steps = 0;
  // Sums of ranges, so that they are the same for any number of threads.
  constexpr std::size_t kRange = 4096;
  struct Sums {
    double bright = 0.0, ones = 0.0;
  };
  std::vector<Sums> sums((targets.size() + kRange - 1) / kRange);
  for_each_range(targets.size(), kRange, [&](std::size_t begin, std::size_t end) {
    Sums& here = sums[begin / kRange];
    for (const float t : targets.subspan(begin, end - begin)) {
      if (!std::isfinite(t)) continue;
      const double target =
          std::min(static_cast<double>(std::abs(t)), static_cast<double>(trainer.options().max_target));
      here.bright += target;
      here.ones += (target - 1.0) * (target - 1.0);
    }
  });
  double bright = 0.0, ones = 0.0;
  for (const Sums& part : sums) {
    bright += part.bright;
    ones += part.ones;
  }
  const double values = static_cast<double>(targets.size());
  brightest = std::max(brightest, bright / values);
  if (loss > kGreatestLoss * std::max(ones / values, kFloor)) {
    throw TrainingDiverged(
        fmt::format("training step {}: the loss is {:.3g}, but that of a constant answer is {:.3g}",
                    steps_done, loss, ones / values));
  }

  const std::size_t outputs = trainer.model().config.mlp.outputs;
  std::vector<float> answers(some.size * outputs);
  trainer.query(some, {.range = neural::OutputRange::raw}, answers);
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < some.size; ++i) {
    if (!neural::is_finite(trainer.model(), some, i)) continue;
    for (std::size_t o = 0; o < outputs; ++o) sum += static_cast<double>(std::abs(answers[i * outputs + o]));
    count += static_cast<double>(outputs);
  }
  const double mean = count > 0.0 ? sum / count : 0.0;
  if (!(mean <= kGreatestBrightness * brightest)) {
    throw TrainingDiverged(
        fmt::format("training step {}: the mean answer is {:.3g}, but the mean target is {:.3g}", steps_done,
                    mean, brightest));
  }
  if (steps >= kFirstLooked && loss_average <= kGoodAverage * loss_least && loss <= kGoodGroup * loss_average)
    good_steps = steps_done;
}

}  // namespace gatelight::renderer

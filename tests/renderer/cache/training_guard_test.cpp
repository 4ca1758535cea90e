#include "renderer/cache/training_guard.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/errors.h"

namespace gatelight::renderer {
namespace {

neural::StepStatistics step_of(double loss) {
  neural::StepStatistics step;
  step.records = 1;
  step.loss = loss;
  return step;
}

/// The number of steps of this loss, after 300 steps of another, until training counts as diverged; 0: never.
int steps_until_diverged(double before, double loss) {
  TrainingGuard guard;
  for (int i = 0; i < 300; ++i) guard.look_at_loss(step_of(before), 1);
  for (int i = 1; i < 5000; ++i) {
    try {
      guard.look_at_loss(step_of(loss), 1);
    } catch (const TrainingDiverged&) {
      return i;
    }
  }
  return 0;
}

TEST(TrainingGuard, AMeanLossOfTenTimesItsLeastIsDivergence) {
  EXPECT_EQ(steps_until_diverged(1.0, 9.9), 0);
  // 1 + 10 (1 - 0.995^n) > 10
  EXPECT_EQ(steps_until_diverged(1.0, 11.0), 460);
  EXPECT_EQ(steps_until_diverged(0.1, 1.1), 460);
}

TEST(TrainingGuard, ASingleStepCountsForTenTimesTheMean) {
  TrainingGuard guard;
  for (int i = 0; i < 300; ++i) guard.look_at_loss(step_of(1.0), 1);
  guard.look_at_loss(step_of(1e9), 1);
  EXPECT_NEAR(guard.loss_average, 1.045, 1e-9);
  EXPECT_NEAR(guard.loss_least, 1.0, 1e-9);
}

TEST(TrainingGuard, SmallLossesMayVary) {
  EXPECT_EQ(steps_until_diverged(1e-6, 0.099), 0);
  EXPECT_NE(steps_until_diverged(1e-6, 0.2), 0);
}

TEST(TrainingGuard, TheFirst200StepsMayFallAndRise) {
  TrainingGuard guard;
  guard.look_at_loss(step_of(0.1), 1);
  for (int i = 1; i < 199; ++i) EXPECT_NO_THROW(guard.look_at_loss(step_of(100.0), 1));
}

TEST(TrainingGuard, ALossThatIsNotFiniteIsDivergenceAtOnce) {
  TrainingGuard guard;
  EXPECT_THROW(guard.look_at_loss(step_of(std::numeric_limits<double>::quiet_NaN()), 1), TrainingDiverged);
  EXPECT_THROW(guard.look_at_loss(step_of(std::numeric_limits<double>::infinity()), 1), TrainingDiverged);
  neural::StepStatistics nothing = step_of(std::numeric_limits<double>::quiet_NaN());
  nothing.records = 0;
  EXPECT_NO_THROW(guard.look_at_loss(nothing, 1));
  EXPECT_EQ(guard.steps, 0u);
}

}  // namespace
}  // namespace gatelight::renderer

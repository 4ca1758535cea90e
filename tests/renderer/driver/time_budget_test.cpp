#include "renderer/driver/time_budget.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/driver/error_checks.h"

namespace gatelight::renderer {
namespace {

TEST(TimeBudget, PassesEndWhereTheDenoiserBegins) {
  EXPECT_DOUBLE_EQ((TimeBudget{10.0, 0.6}).passes_end(), 9.4);
  EXPECT_EQ((TimeBudget{0.5, 0.6}).passes_end(), 0.0);
  EXPECT_TRUE(std::isinf(TimeBudget{}.passes_end()));
}

TEST(TimeBudget, TrainingHasAShareOfWhatIsLeft) {
  const TimeBudget budget{10.0, 1.0};
  for (const bool samples : {false, true}) {
    const double early = budget.training_end(1.0, samples), late = budget.training_end(5.0, samples);
    EXPECT_GT(early, 1.0);
    EXPECT_LT(early, 9.0);
    EXPECT_NEAR((early - 1.0) / 8.0, (late - 5.0) / 4.0, 1e-12) << "the same share of less";
    EXPECT_EQ(budget.training_end(9.5, samples), 9.5) << "nothing is left";
  }
  EXPECT_GT(budget.training_end(1.0, true), budget.training_end(1.0, false)) << "its samples are not lost";
}

TEST(TimeBudget, AGroupOfStepsNeverEndsLate) {
  EXPECT_TRUE(group_fits(1.0, 0.5, 1.5));
  EXPECT_FALSE(group_fits(1.0, 0.6, 1.5));
}

TEST(TimeBudget, APassEndsAtMostHalfOfItsTimeLate) {
  EXPECT_TRUE(pass_fits(1.0, 0.6, 1.3));
  EXPECT_FALSE(pass_fits(1.0, 0.6, 1.29));
  EXPECT_TRUE(pass_fits(1.0, 1e9, std::numeric_limits<double>::infinity()));
}

TEST(TimeBudget, APassHasTheSamplesThatFit) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  EXPECT_EQ(samples_of_pass(0.0, 0.125, 0.75, kNever, 100), 6);
  EXPECT_EQ(samples_of_pass(0.0, 0.125, 0.75, kNever, 4), 4);
  EXPECT_EQ(samples_of_pass(0.0, 0.125, 0.75, 0.25, 100), 2) << "the end is near";
  EXPECT_EQ(samples_of_pass(1.0, 0.125, 0.75, 0.5, 100), 1) << "the end is past";
  EXPECT_EQ(samples_of_pass(0.0, 0.0, 0.75, kNever, 100), 100);
}

TEST(ErrorChecks, TheirSamplesGrowByTheRootOfTwo) {
  int samples = 0;
  for (const int expected : {4, 6, 8, 11, 16, 23, 32, 45, 64}) {
    samples = next_check(samples);
    EXPECT_EQ(samples, expected);
    EXPECT_TRUE(is_check(samples));
    EXPECT_EQ(next_check(samples - 1), samples);
  }
  for (const int between : {0, 1, 2, 3, 5, 7, 9, 12, 63}) EXPECT_FALSE(is_check(between)) << between;
  EXPECT_GT(next_check(1 << 24), 1 << 24);
  EXPECT_EQ(next_check(std::numeric_limits<int>::max() - 1), std::numeric_limits<int>::max());
}

}  // namespace
}  // namespace gatelight::renderer

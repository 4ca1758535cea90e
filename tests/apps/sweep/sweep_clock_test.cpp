#include "apps/sweep/sweep_progress.h"

#include <gtest/gtest.h>

namespace gatelight::apps {
namespace {

TEST(SweepClock, EstimatesTheRestByTheTimesOfEachKind) {
  SweepClock clock;
  EXPECT_FALSE(clock.left(0.0, 0.0).has_value()) << "there is no plan yet";
  clock.plan_rest({{"nrc", 10.0}, {"path", 4.0}, {"nrc", 20.0}});
  EXPECT_EQ(clock.count(), 3u);
  EXPECT_FALSE(clock.left(1.0, 0.0).has_value());
  EXPECT_FALSE(clock.left(1.0, 0.5).has_value());
  clock.finish(5.0);
  EXPECT_DOUBLE_EQ(*clock.left(1.0, 0.0), 1.0 + 10.0) << "path was never done, and is as quick as nrc";
  clock.finish(8.0);
  EXPECT_DOUBLE_EQ(*clock.left(4.0, 0.0), 6.0);
  EXPECT_DOUBLE_EQ(*clock.left(40.0, 0.0), 0.0);
  clock.finish(10.0);
  EXPECT_DOUBLE_EQ(*clock.left(0.0, 0.0), 0.0);
  clock.plan_rest({{"path", 2.0}, {"ao", 34.0}});
  EXPECT_DOUBLE_EQ(*clock.left(0.0, 0.0), 4.0 + 23.0);
}

TEST(SweepClock, TheFirstTaskIsEstimatedByItsFraction) {
  SweepClock clock;
  clock.plan_rest({{"path", 4.0}});
  EXPECT_DOUBLE_EQ(*clock.left(1.0, 0.25), 3.0);
}

TEST(SweepClock, TheWorkOfAPictureIsItsSamples) {
  RenderSettings settings;
  settings.render.width = 10;
  settings.render.height = 10;
  EXPECT_EQ(reference_task(settings.render, ReferenceKind::path, 4).work, 400.0);
  EXPECT_EQ(reference_task(settings.render, ReferenceKind::ao, 8).work, 800.0);
}

}  // namespace
}  // namespace gatelight::apps

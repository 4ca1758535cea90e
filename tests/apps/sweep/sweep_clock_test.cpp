#include "apps/sweep/eta.h"

#include <gtest/gtest.h>

namespace gatelight::apps {
namespace {

TEST(SweepClock, EstimatesTheRestOnceEachKindWasTimed) {
  SweepClock clock;
  clock.plan_rest({{{"a nrc", "nrc"}, 10.0}, {{"a path", "path"}, 4.0}, {{"a nrc", "nrc"}, 20.0}});
  EXPECT_EQ(clock.count(), 3u);
  EXPECT_FALSE(clock.left(1.0, 0.0).has_value());
  EXPECT_FALSE(clock.left(1.0, 0.5).has_value());
  clock.finish(5.0);
  EXPECT_FALSE(clock.left(1.0, 0.0).has_value()) << "path was never done";
  EXPECT_DOUBLE_EQ(*clock.left(1.0, 0.25), 3.0 + 10.0) << "its own fraction is enough";
  clock.finish(2.0);
  EXPECT_DOUBLE_EQ(*clock.left(4.0, 0.0), 6.0);
  EXPECT_DOUBLE_EQ(*clock.left(40.0, 0.0), 0.0);
  clock.finish(10.0);
  EXPECT_DOUBLE_EQ(*clock.left(0.0, 0.0), 0.0);
  // Another scene is estimated from this one.
  clock.plan_rest({{{"b nrc", "nrc"}, 2.0}, {{"b nrc", "nrc"}, 4.0}});
  EXPECT_DOUBLE_EQ(*clock.left(0.0, 0.0), 3.0);
  // Once it has a finished task of its own, the estimate uses that one.
  clock.finish(10.0);
  EXPECT_DOUBLE_EQ(*clock.left(0.0, 0.0), 20.0);
}

TEST(SweepClock, EstimatesKindsThatWereNeverTimed) {
  const PlannedScene scene{.name = "a"};
  RenderSettings settings;
  settings.render.width = 10;
  settings.render.height = 10;
  SweepClock clock;
  clock.plan_rest({reference_task(scene, settings.render, ReferenceKind::path, 4),
                   reference_task(scene, settings.render, ReferenceKind::ao, 8)});
  clock.finish(6.0);
  EXPECT_DOUBLE_EQ(*clock.left(0.0, 0.0), 12.0);
}

}  // namespace
}  // namespace gatelight::apps

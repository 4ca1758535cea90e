// Changes of the light, found in records.

#include "renderer/cache/light_change.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "tests/renderer/cache/small_worlds.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;

constexpr std::size_t kRecords = 100'000;

/// Records on a square of 8 m. Their light is 1 in the mean, with the given number of equal parts that are
/// zero for each that is not.
struct Records {
  explicit Records(double darkness) {
    builder.quad(builder.material(SceneBuilder::lambert(Color::Constant(0.5f))), Vec3(-4, 0, -4),
                 Vec3(0, 0, 8), Vec3(8, 0, 0));
    for (std::size_t i = 0; i < kRecords; ++i) {
      Hit hit;
      hit.instance = 0;
      hit.primitive = i % 2;
      hit.u = uniform_float(1, i);
      hit.v = (1.0f - hit.u) * uniform_float(2, i);
      const Surface surface{};
      batch.records.push_back(surface_point(hit, 0, Vec3::UnitY(), surface, Color::Ones()));
      const bool bright = static_cast<double>(uniform_float(3, i)) * (1.0 + darkness) < 1.0;
      const auto light = static_cast<float>(bright ? 1.0 + darkness : 0.0);
      batch.targets.insert(batch.targets.end(), 3, light);
      answers.insert(answers.end(), 3, 1.0f);
    }
  }

  double change() const { return light_change(builder.scene(), batch, answers, 3); }
  bool on_the_left(std::size_t i) const {
    const auto corners =
        scene::world_triangle(builder.scene(), builder.scene().instances[0], batch.records.triangle(i));
    const auto& [u, v] = batch.records.barycentrics(i);
    return ((1.0f - u - v) * corners[0] + u * corners[1] + v * corners[2]).x() < 0.0f;
  }

  mutable SceneBuilder builder;
  RecordBatch batch;
  std::vector<float> answers;
};

TEST(LightChange, IsNoneWhereAnswersAreRightInTheMean) {
  EXPECT_EQ(Records(0.0).change(), 0.0);
  EXPECT_LT(Records(3.0).change(), 0.01);
  EXPECT_LT(Records(50.0).change(), 0.02) << "a long tail";
}

TEST(LightChange, IsOneWhereTheLampsWentOff) {
  Records records(3.0);
  std::fill(records.batch.targets.begin(), records.batch.targets.end(), 0.0f);
  EXPECT_NEAR(records.change(), 1.0, 1e-9);
}

TEST(LightChange, IsTheShareOfWhatChanged) {
  Records records(3.0);
  for (std::size_t i = 0; i < kRecords; ++i) {
    if (records.on_the_left(i))
      std::fill_n(records.answers.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, 5.0f);
  }
  EXPECT_NEAR(records.change(), 2.0 / 3.0, 0.08) << "together they are three times as bright as right";
}

TEST(LightChange, NoticesALittleLessEverywhere) {
  Records records(3.0);
  for (float& target : records.batch.targets) target *= 0.9f;
  EXPECT_NEAR(records.change(), 0.1, 0.03) << "too little for any cell";
}

TEST(LightChange, IsNoneWhereUnevenLightIsALittleLess) {
  Records records(8.0);
  for (float& target : records.batch.targets) target *= 0.9f;
  EXPECT_LT(records.change(), 0.02) << "the mean may lack rare bright samples";
}

TEST(LightChange, LeavesOutWhatIsNotFinite) {
  Records records(0.0);
  records.batch.targets[0] = std::nanf("");
  records.answers[3] = kInfinity;
  EXPECT_EQ(records.change(), 0.0);
  EXPECT_EQ(light_change(records.builder.scene(), RecordBatch{}, {}, 3), 0.0);
}

}  // namespace
}  // namespace gatelight::renderer

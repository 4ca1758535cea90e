// Each point gives one record of openness.

#include "renderer/cache/occlusion_records.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/renderer/cache/small_worlds.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;
using testing::view_from;
using testing::ViewedWorld;

RecordBatch made(const ViewedWorld& viewed, const RenderOptions& options, const RecordRequest& request,
                 const StoredSurfaces& stored, float distance) {
  const TrainingPoints points(viewed.world, viewed.camera, viewed.region, options, {}, nullptr);
  OcclusionRecords records(viewed.world, points, options, stored, distance, {});
  RecordBatch batch;
  records.begin(request, batch);
  records.trace(batch);
  records.finish({}, batch);
  records.split(request, batch);
  EXPECT_EQ(records.rays().camera,
            batch.paths_traced / static_cast<std::size_t>(options.cache.samples_per_point));
  return batch;
}

/// A block on a floor that fills half of the picture.
SceneBuilder block() {
  SceneBuilder builder;
  const int matte = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  builder.quad(matte, Vec3(-3, 0, 3), Vec3(6, 0, 0), Vec3(0, 0, -6));
  builder.box(matte, Vec3(-0.5f, 0.001f, -0.5f), Vec3(0.5f, 0.8f, 0.5f));
  builder.scene().cameras.push_back(view_from(Vec3(1, 1.5f, 4), Vec3(0, 0.8f, 0)));
  return builder;
}

TEST(OcclusionRecords, APointIsOneRecordAndASkyIsNone) {
  const ViewedWorld viewed(block());
  for (const int times : {1, 4}) {
    RenderOptions options;
    options.cache.samples_per_point = times;
    const RecordBatch batch = made(viewed, options, {.step = 2, .points = 768}, {}, 1.0f);
    ASSERT_EQ(batch.starts.starts.size(), 768u * static_cast<std::size_t>(times));
    std::size_t met = 0;
    for (std::size_t i = 0; i < batch.starts.hits.size(); i += static_cast<std::size_t>(times))
      met += batch.starts.hits[i] ? 1 : 0;
    EXPECT_GT(met, 200u);
    EXPECT_LT(met, 700u);
    EXPECT_EQ(batch.records.size(), met);
    ASSERT_EQ(batch.targets.size(), met);
    std::set<float> distinct;
    for (const float t : batch.targets) {
      const float count = t * static_cast<float>(times);
      ASSERT_EQ(count, std::round(count)) << "a whole number of open rays";
      ASSERT_TRUE(t >= 0.0f && t <= 1.0f);
      distinct.insert(t);
    }
    EXPECT_GE(distinct.size(), times == 1 ? 2u : 3u);
  }
}

TEST(OcclusionRecords, SurfacesWithoutStorageLeaveNone) {
  const ViewedWorld viewed(block());
  const RenderOptions options;
  const StoredSurfaces stored(viewed.world.scene,
                              std::vector<neural::Sides>{neural::Sides::none, neural::Sides::front});
  const RecordBatch batch = made(viewed, options, {.step = 2, .points = 768}, stored, 1.0f);
  ASSERT_GT(batch.records.size(), 30u);
  for (std::size_t i = 0; i < batch.records.size(); ++i) ASSERT_EQ(batch.records.surface(i), 2u);
}

}  // namespace
}  // namespace gatelight::renderer

// The network's inputs beside the position follow from scene, encoding and preset.

#include "renderer/cache/cache_model.h"

#include <gtest/gtest.h>

#include "renderer/settings/presets.h"
#include "renderer/transport/world.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;

class CacheModel : public ::testing::Test {
 protected:
  const scene::Scene& matte_quad() {
    builder_.quad(builder_.material(SceneBuilder::lambert(Color::Constant(0.5f))), Vec3::Zero(),
                  Vec3::UnitX(), Vec3::UnitY());
    return builder_.scene();
  }

  SceneBuilder builder_;
  World world_{matte_quad()};
};

TEST_F(CacheModel, TheNormalIsAnInputExceptForThePapersGate) {
  RenderOptions options;
  EXPECT_TRUE(required_inputs(world_, options).normal);
  options.cache.encoding = neural::FeatureEncoding::hash_grid;
  EXPECT_TRUE(required_inputs(world_, options).normal);
  for (const CachePreset preset : {CachePreset::paper_nao, CachePreset::paper_nrc}) {
    RenderOptions paper;
    apply_preset(preset, paper);
    EXPECT_FALSE(required_inputs(world_, paper).normal);
    paper.cache.encoding = neural::FeatureEncoding::hash_grid;
    EXPECT_TRUE(required_inputs(world_, paper).normal);
    paper.cache.encoding = neural::FeatureEncoding::gate;
    paper.cache.normal_input = true;
    EXPECT_TRUE(required_inputs(world_, paper).normal);
  }
}

TEST_F(CacheModel, TheDirectionIsAnInputWhereCachedLightDependsOnIt) {
  RenderOptions options;
  options.integrator = Integrator::nrc;
  options.cache.min_roughness = 0.25f;
  EXPECT_FALSE(required_inputs(world_, options).direction);
  world_.requirements.view_dependent = true;
  EXPECT_TRUE(required_inputs(world_, options).direction);
  options.cache.min_roughness = 0.5f;
  EXPECT_FALSE(required_inputs(world_, options).direction);
  options.cache.min_roughness = 0.25f;
  options.integrator = Integrator::nao;
  EXPECT_FALSE(required_inputs(world_, options).direction);
}

TEST_F(CacheModel, OnlyTheHashGridOfRadianceReadsTheAlbedo) {
  RenderOptions options;
  options.integrator = Integrator::nrc;
  EXPECT_FALSE(required_inputs(world_, options).albedo);
  options.cache.encoding = neural::FeatureEncoding::hash_grid;
  EXPECT_TRUE(required_inputs(world_, options).albedo);
  options.integrator = Integrator::nao;
  EXPECT_FALSE(required_inputs(world_, options).albedo);
}

}  // namespace
}  // namespace gatelight::renderer

#include "renderer/cache/cache_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "base/errors.h"
#include "neural/cpu/cpu_backend.h"
#include "neural/vulkan/vulkan_backend.h"
#include "renderer/cache/scene_layout.h"

namespace gatelight::renderer {
namespace {

/// Memory limit of the features where the options give neither spacing nor memory. Bistro, 144 steps: 231 MB
/// became 99 MB with the same error (squared bias 0.016), and the run took 2 s less; with 46 MB it was 0.019.
constexpr std::uint64_t kChosenBytes = std::uint64_t{96} << 20;

/// For lobes at least this rough the direction of view does not improve learning: README.md, "Defaults".
constexpr float kRoughForAll = 0.5f;

}  // namespace

neural::RequiredInputs required_inputs(const World& world, const RenderOptions& options) {
  const CacheOptions& cache = options.cache;
  const bool hash_grid = cache.encoding == neural::FeatureEncoding::hash_grid;
  neural::RequiredInputs required;
  // Occlusion does not depend on the direction of view.
  required.direction =
      cache.direction_input.value_or(options.integrator == Integrator::nrc &&
                                     world.requirements.view_dependent && cache.min_roughness < kRoughForAll);
  // Features of small triangles are constant over a cluster; the normal varies the answer there. The paper
  // omits it.
  required.normal =
      cache.normal_input.value_or(hash_grid || cache.gate.rule != neural::ResolutionRule::paper);
  required.albedo = cache.albedo_input.value_or(hash_grid && options.integrator == Integrator::nrc);
  return required;
}

neural::ModelConfig model_config(const CacheOptions& cache, const Box& bounds) {
  neural::ModelConfig config;
  config.encoding = cache.encoding;
  config.gate = cache.gate;
  if (cache.node_spacing) config.gate.node_spacing = *cache.node_spacing;
  config.gate.memory_budget = cache.memory_bytes;
  config.gate.bytes_per_feature = cache.training.precision == neural::FeaturePrecision::fp32 ? 4 : 2;
  config.hash_grid = cache.hash_grid;
  config.hash_grid.memory_target = cache.memory_bytes;
  config.hash_grid.bytes_per_feature = config.gate.bytes_per_feature;
  config.mlp = cache.mlp;
  if (!bounds.isEmpty()) {
    for (int axis = 0; axis < 3; ++axis) {
      config.hash_grid.bounds_min[static_cast<std::size_t>(axis)] = bounds.min()[axis];
      config.hash_grid.bounds_max[static_cast<std::size_t>(axis)] = bounds.max()[axis];
    }
  }
  return config;
}

std::shared_ptr<const neural::Model> make_cache_model(const World& world, const RenderOptions& options,
                                                      const CacheSetup& setup) {
  const CacheOptions& cache = options.cache;
  neural::ModelConfig config = model_config(cache, world.scene.bounds);
  config.gate.node_spacing = setup.node_spacing;
  config.auxiliary = neural::composite_inputs(required_inputs(world, options));
  config.mlp.outputs = options.integrator == Integrator::nao ? 1 : 3;
  if (config.encoding != neural::FeatureEncoding::gate) return neural::make_model(config);
  const WeldedMeshes meshes(world.scene);
  const neural::SurfaceLayout surfaces = meshes.layout(world.scene, setup.sides, setup.spacing_scales);
  if (!cache.node_spacing && cache.memory_bytes == 0 && config.gate.rule == neural::ResolutionRule::uniform) {
    config.gate.memory_budget = kChosenBytes;
    config.gate.budget_is_cap = true;
  }
  return neural::make_model(config, surfaces);
}

neural::TrainingOptions training_options(const RenderOptions& options) {
  neural::TrainingOptions training = options.cache.training;
  training.seed = training.seed * 0x9e3779b97f4a7c15u + options.seed;
  return training;
}

}  // namespace gatelight::renderer

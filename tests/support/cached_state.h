#pragma once
// A cache in the state of some training, for the tests of files.

#include <cstdint>
#include <memory>

#include "renderer/cache/cache_state.h"
#include "tests/support/model_cases.h"
#include "tests/support/stored_state.h"

namespace gatelight::testing {

/// Few nodes: files are mutated byte by byte.
inline std::shared_ptr<const neural::Model> small_model(
    neural::FeatureEncoding encoding = neural::FeatureEncoding::gate) {
  neural::ModelConfig config = neural::testing::default_gate_config();
  config.encoding = encoding;
  config.mlp.width = 16;
  config.mlp.hidden_layers = 1;
  config.gate.features = 1;
  config.hash_grid.levels = 1;
  config.hash_grid.features = 1;
  config.hash_grid.log2_table_size = 4;
  return neural::testing::make_case("small", config).model;
}

inline renderer::CacheState any_cache_state(const neural::Model& model,
                                            const neural::TrainingOptions& options, std::uint64_t seed) {
  using neural::Sides;
  renderer::CacheState state;
  state.setup = {{Sides::front, Sides::both, Sides::back, Sides::none, Sides::front},
                 0.1f,
                 {1.0f, 0.5f, 2.0f, 1.0f, 3.0f},
                 0.3f,
                 5.5f,
                 0.0625f};
  state.model = neural::testing::any_state(model, options, seed);
  state.steps = 1234 + seed;
  state.triangle_counts = {7, 0, 0xffffffffu, static_cast<std::uint32_t>(seed)};
  return state;
}

inline bool same_bits(const renderer::CacheSetup& a, const renderer::CacheSetup& b) {
  return a.sides == b.sides && a.spacing_scales == b.spacing_scales && a.node_spacing == b.node_spacing &&
         a.target_scale == b.target_scale && a.records_per_path == b.records_per_path &&
         a.records_per_short_path == b.records_per_short_path;
}

inline bool same_bits(const renderer::CacheState& a, const renderer::CacheState& b) {
  return same_bits(a.setup, b.setup) && neural::testing::same_bits(a.model, b.model) && a.steps == b.steps &&
         a.triangle_counts == b.triangle_counts && a.guard == b.guard;
}

}  // namespace gatelight::testing

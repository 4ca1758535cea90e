#pragma once
// The model for the options and the requirements of a scene.

#include <memory>

#include "neural/model/model.h"
#include "renderer/cache/cache_state.h"
#include "renderer/settings/options.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// Inputs beside the position that the options and the scene require.
neural::RequiredInputs required_inputs(const World& world, const RenderOptions& options);

/// What options and bounds say of a model; inputs, outputs and a spacing that is chosen are left open.
neural::ModelConfig model_config(const CacheOptions& cache, const Box& bounds);

/// Throws BadConfiguration.
std::shared_ptr<const neural::Model> make_cache_model(const World& world, const RenderOptions& options,
                                                      const CacheSetup& setup);

neural::TrainingOptions training_options(const RenderOptions& options);

}  // namespace gatelight::renderer

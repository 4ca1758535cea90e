#pragma once
// Options and a scene's requirements become a model.

#include <memory>

#include "neural/model/model.h"
#include "renderer/cache/cache_state.h"
#include "renderer/settings/options.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// Inputs beside the position that the options and the scene ask for.
neural::RequiredInputs required_inputs(const World& world, const RenderOptions& options);

/// Throws neural::BadConfiguration.
std::shared_ptr<const neural::Model> make_cache_model(const World& world, const RenderOptions& options,
                                                      const CacheSetup& setup);

neural::TrainingOptions training_options(const RenderOptions& options);

/// Steps for a picture of so many samples, where the caller leaves it open.
int choose_training_steps(const RenderOptions& options, std::uint64_t pixels);

}  // namespace gatelight::renderer

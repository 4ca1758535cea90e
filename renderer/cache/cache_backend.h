#pragma once
// The device or instruction set on which the cache computes.

#include <memory>
#include <string>

#include "neural/model/backend.h"
#include "renderer/settings/options.h"

namespace gatelight::renderer {

/// The backend that options.cache.device and options.isa name. Throws Unavailable.
std::unique_ptr<neural::Backend> make_cache_backend(std::shared_ptr<const neural::Model> model,
                                                    const RenderOptions& options);

/// The instruction set or device of that backend as text for files. Results of another one differ in the last
/// bits.
std::string cache_machine(const RenderOptions& options);

}  // namespace gatelight::renderer

#pragma once
// What the cache computes on.

#include <memory>
#include <string>

#include "neural/model/backend.h"
#include "renderer/settings/options.h"

namespace gatelight::renderer {

/// The backend that options.cache.device and options.isa name. Throws Unavailable.
std::unique_ptr<neural::Backend> make_cache_backend(std::shared_ptr<const neural::Model> model,
                                                    const RenderOptions& options);

/// The instruction set or device of that backend, in words for files: another one has other last bits.
std::string cache_machine(const RenderOptions& options);

}  // namespace gatelight::renderer

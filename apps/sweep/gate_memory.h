#pragma once
// The bytes of the features of a cache on a scene, so that another encoding can take as many.

#include <cstdint>
#include <string>

#include "renderer/settings/options.h"
#include "scene/scene.h"

namespace gatelight::apps {

/// The bytes for scene and options, whose key is `key`. `file` keeps them, because computing them builds the
/// scene's acceleration structure and scouts. Throws what renderer::Renderer throws, and OutputError.
std::uint64_t gate_memory(const std::string& file, const std::string& key, const scene::Scene& scene,
                          const renderer::RenderOptions& options);

}  // namespace gatelight::apps

#pragma once
// GATELIGHT_visibility and GATELIGHT_light_linking: which rays see an object, and which objects a light
// concerns.

#include <vector>

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace gatelight::scene::gltf {

inline constexpr const char* kVisibilityExtension = "GATELIGHT_visibility";

/// Of the extensions of a node or a scene.
Visibility read_visibility(const tinygltf::ExtensionMap& extensions);

/// The nodes of what the scene shows.
struct SourceNodes {
  std::vector<int> placements;  ///< by Instance::placement
  std::vector<int> lights;      ///< of punctual lights
};

/// Sets the links of the scene's lights, with the object sets. `shown`: the scene's index in the file. The
/// scene's lists of instances must be complete. Throws InputError if there are too many sets.
void read_light_links(const Document& document, int shown, const SourceNodes& nodes, Scene& scene,
                      Warnings& warnings);

}  // namespace gatelight::scene::gltf

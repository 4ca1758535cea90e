#pragma once
// Lights that are chosen by name.

#include <string>

#include "scene/scene.h"

namespace gatelight::scene {

/// Whether the name of a punctual light or of an emissive material is the wanted one, or begins so where that
/// ends with '*'.
bool fits_name(const std::string& wanted, const std::string& name);

/// "one of its lights 'a', 'b', or one of its emissive materials 'c'", for messages.
std::string describe_light_names(const Scene& scene);
/// "one of 'a', 'b'": point and spot lights.
std::string describe_placed_lights(const Scene& scene);

}  // namespace gatelight::scene

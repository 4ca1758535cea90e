#pragma once
// The environment of a scene (EXT_lights_image_based).

#include <optional>

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace gatelight::scene::gltf {

/// The environment of scene `index` of the file, if it has one. Coarser levels and the coefficients of its
/// irradiance are not read: paths filter it themselves. Throws InputError; see load_image() for
/// `missing_is_error`.
std::optional<ImageBasedLight> load_image_light(const Document& document, int index, bool missing_is_error,
                                                Warnings& warnings);

}  // namespace gatelight::scene::gltf

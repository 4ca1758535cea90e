#pragma once
// What a picture shows at a place.

#include <nlohmann/json_fwd.hpp>

#include "apps/view/scene_outline.h"
#include "renderer/image/picture.h"

namespace gatelight::apps {

/// `x`, `y` in [0, 1] from the picture's top left corner. Has the values of every layer, and where a surface
/// is there, and the picture is of a scene with an outline: its place, the object's name, and the centre and
/// radius of the object's box. Throws BadOption for a place outside the picture.
nlohmann::ordered_json pixel_report(const renderer::Picture& picture, const SceneOutline* outline, double x,
                                    double y);

}  // namespace gatelight::apps

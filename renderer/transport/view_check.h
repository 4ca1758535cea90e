#pragma once
// Whether a camera sees the scene.

#include <string>

#include "renderer/film/camera.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// One line for a view that shows nothing, or mostly the backs of surfaces that have no back side, as from
/// inside an object; empty for any other. It has the share of rays of a coarse grid over the picture. Size in
/// pixels.
std::string view_warning(const World& world, const Camera& camera, int width, int height);

/// Distance in metres along the view to the surface in the middle of the picture; without one, to the middle
/// of the scene.
float distance_in_the_middle(const World& world, const Camera& camera, int width, int height);

}  // namespace gatelight::renderer

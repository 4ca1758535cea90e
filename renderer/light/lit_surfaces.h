#pragma once
// The light that a scene's glowing surfaces give to the others, without tracing rays.

#include "scene/scene.h"

namespace gatelight::renderer {

/// Mean radiance of the surfaces that do not emit, on the sides that their materials have, were they white
/// and were nothing between them and those that do. Over a closed room this is about the emitted flux over pi
/// times its area. An estimate by random points of both kinds, the same at each call; 0 if one kind is
/// missing.
double lit_radiance(const scene::Scene& scene);

}  // namespace gatelight::renderer

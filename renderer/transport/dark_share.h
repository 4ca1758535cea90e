#pragma once
// How much of what a camera sees lies in the dark.

#include "renderer/film/camera.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// The share of the visible surfaces that a screen shows black, of those that do not glow themselves, with
/// the exposure that suits the picture (image/auto_exposure.h); 0 where all glow. Some paths of a coarse
/// picture estimate it, the same ones at each call. `around`: the volumes that the camera is in. Runs in the
/// caller's arena.
double dark_share(const World& world, const View& view, const Camera& camera, double aspect);

}  // namespace gatelight::renderer

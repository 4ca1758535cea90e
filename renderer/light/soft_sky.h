#pragma once
// Light for scenes that have none of their own.

#include "renderer/light/environment_picture.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// Whether there are surfaces to be lit.
bool reflects(const scene::Scene& scene);

/// Whether some surface emits.
bool glows(const scene::Scene& scene);

/// A grey-blue sky over a darker ground, with a broad bright spot at the upper left, behind a viewer who
/// looks along -z. A white surface in it has a radiance near 1. All values are multiplied by `scale`.
EnvironmentPicture make_soft_sky(float scale);

}  // namespace gatelight::renderer

#pragma once
// The environment of a scene's file: a cube of pictures.

#include "renderer/light/environment_picture.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// A latitude-longitude picture in the world's directions, with as many texels around as the faces have,
/// times `scale`. Values are bounded as those of other environments.
EnvironmentPicture make_cube_picture(const scene::ImageBasedLight& light, float scale);

}  // namespace gatelight::renderer

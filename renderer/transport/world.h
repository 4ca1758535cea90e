#pragma once
// A scene made ready for light: what an integrator reads. Nothing in it changes while a picture is made.

#include "renderer/light/environment.h"
#include "renderer/light/lights.h"
#include "renderer/surface/accel.h"
#include "renderer/surface/coverage.h"
#include "renderer/surface/surface.h"
#include "renderer/surface/texture.h"
#include "scene/requirements.h"
#include "scene/scene.h"

namespace gatelight::renderer {

struct World {
  const scene::Scene& scene;
  const scene::SceneRequirements& requirements;
  const Textures& textures;
  const Surfaces& surfaces;
  const Accel& accel;
  const Environment& environment;
  const Lights& lights;
};

}  // namespace gatelight::renderer

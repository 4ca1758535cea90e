#pragma once
// Generates primary rays.

#include "renderer/surface/ray.h"
#include "renderer/surface/surface.h"
#include "scene/scene.h"

namespace gatelight::renderer {

struct CameraRay {
  Ray ray;
  RayCone cone;
};

class Camera {
 public:
  /// Takes the scene's camera and the size of the picture in pixels. The picture's aspect ratio replaces that
  /// of the camera; the vertical field of view stays.
  Camera(const scene::Camera& camera, int width, int height);

  /// `x` and `y` are in pixels from the top left corner of the picture.
  CameraRay ray(float x, float y) const;

 private:
  Vec3 origin_;
  Vec3 right_;  ///< one pixel, at a distance of one metre (perspective) or in the world (orthographic)
  Vec3 down_;
  Vec3 corner_;  ///< the top left corner of the picture: a direction (perspective) or a point (orthographic)
  Vec3 forward_;
  RayCone cone_;
  bool orthographic_ = false;
};

}  // namespace gatelight::renderer

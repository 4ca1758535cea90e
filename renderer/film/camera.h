#pragma once
// Primary rays.

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
  /// A camera of the file for a picture of this size. Where the camera has an aspect ratio of its own and the
  /// picture another, the vertical field of view is kept.
  Camera(const scene::Camera& camera, int width, int height);

  /// x, y in pixels from the top left corner of the picture.
  CameraRay ray(float x, float y) const;

 private:
  Vec3 origin_;
  Vec3 right_;  ///< of one pixel, on the plane one metre ahead (perspective) or in the world (orthographic)
  Vec3 down_;
  Vec3 corner_;  ///< the top left corner of the picture: a direction, or a point
  Vec3 forward_;
  RayCone cone_;
  bool orthographic_ = false;
};

}  // namespace gatelight::renderer

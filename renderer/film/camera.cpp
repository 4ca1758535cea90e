#include "renderer/film/camera.h"

#include <cmath>

namespace gatelight::renderer {

Camera::Camera(const scene::Camera& camera, int width, int height) {
  const Eigen::Matrix3f frame = camera.transform.linear();
  origin_ = camera.transform.translation();
  forward_ = -frame.col(2).normalized();
  const Vec3 right = frame.col(0).normalized();
  const Vec3 up = frame.col(1).normalized();
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  orthographic_ = camera.orthographic;
  const float half_height = orthographic_ ? camera.half_height : std::tan(0.5f * camera.vertical_fov);
  const float half_width = half_height * aspect;
  right_ = right * (2.0f * half_width / static_cast<float>(width));
  down_ = up * (-2.0f * half_height / static_cast<float>(height));
  corner_ = up * half_height - right * half_width;
  const float pixel = 2.0f * half_height / static_cast<float>(height);
  if (orthographic_) {
    corner_ += origin_;
    cone_ = {pixel, 0.0f};
  } else {
    corner_ += forward_;
    cone_ = {0.0f, pixel};
  }
}

CameraRay Camera::ray(float x, float y) const {
  CameraRay result;
  const Vec3 on_plane = corner_ + right_ * x + down_ * y;
  result.ray.origin = orthographic_ ? on_plane : origin_;
  result.ray.direction = orthographic_ ? forward_ : Vec3(on_plane.normalized());
  result.cone = cone_;
  return result;
}

}  // namespace gatelight::renderer

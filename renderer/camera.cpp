#include "renderer/camera.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "renderer/errors.h"

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

namespace {

scene::Affine look_at(const LookAt& view) {
  const Vec3 z = view.eye - view.target;
  if (!(z.squaredNorm() > 0.0f))
    throw BadOption("--eye and --target are the same point; expected two different ones");
  const Vec3 back = z.normalized();
  Vec3 x = view.up.cross(back);
  // Straight up or down: any right vector will do.
  if (!(x.squaredNorm() > 1e-12f * view.up.squaredNorm())) x = back.unitOrthogonal();
  x.normalize();
  scene::Affine transform = scene::Affine::Identity();
  transform.linear().col(0) = x;
  transform.linear().col(1) = back.cross(x);
  transform.linear().col(2) = back;
  transform.translation() = view.eye;
  return transform;
}

/// Three quarters from the front and a little from above, the bounding sphere just inside the picture.
scene::Camera frame_scene(const scene::Scene& scene, float fov, float aspect) {
  scene::Camera camera;
  camera.name = "auto";
  camera.vertical_fov = fov;
  LookAt view;
  if (!scene.bounds.isEmpty()) {
    const Vec3 center = scene.bounds.center();
    const float radius = std::max(0.5f * scene.bounds.diagonal().norm(), 1e-6f * center.norm() + 1e-30f);
    const float narrow = std::min(0.5f * fov, std::atan(std::tan(0.5f * fov) * aspect));
    view.target = center;
    view.eye = center + Vec3(0.45f, 0.3f, 1.0f).normalized() * (radius / std::sin(narrow));
  }
  camera.transform = look_at(view);
  return camera;
}

std::string names_of(const scene::Scene& scene) {
  if (scene.cameras.empty()) return "the file has no camera";
  std::string text = "expected one of";
  for (std::size_t i = 0; i < scene.cameras.size(); ++i)
    text += fmt::format(" {} ({})", i, scene.cameras[i].name);
  return text;
}

}  // namespace

scene::Camera choose_camera(const scene::Scene& scene, const CameraOptions& options, float aspect) {
  const float fov = options.fov_degrees ? *options.fov_degrees * scene::kPi / 180.0f : 0.0f;
  scene::Camera camera;
  if (options.look_at) {
    camera.name = "look-at";
    camera.transform = look_at(*options.look_at);
    camera.transform.translation() -= scene.origin;
  } else if (!options.name.empty()) {
    const scene::Camera* found = nullptr;
    for (const scene::Camera& c : scene.cameras) {
      if (c.name == options.name) {
        found = &c;
        break;
      }
    }
    std::size_t index = 0;
    const char* end = options.name.data() + options.name.size();
    if (!found && std::from_chars(options.name.data(), end, index).ptr == end &&
        index < scene.cameras.size()) {
      found = &scene.cameras[index];
    }
    if (!found)
      throw BadOption(
          fmt::format("--camera {}: no such camera in {}; {}", options.name, scene.path, names_of(scene)));
    camera = *found;
  } else if (!scene.cameras.empty()) {
    camera = scene.cameras.front();
  } else {
    return frame_scene(scene, fov > 0.0f ? fov : camera.vertical_fov, aspect);
  }
  if (fov > 0.0f) camera.vertical_fov = fov;
  return camera;
}

}  // namespace gatelight::renderer

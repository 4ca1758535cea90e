#include "renderer/film/camera_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "renderer/film/framing.h"
#include "renderer/machine/errors.h"

namespace gatelight::renderer {
namespace {

/// In metres. Eyes farther from the origin and larger orthographic pictures are refused: the squares of their
/// distances would leave single precision.
constexpr float kFurthest = 1e12f;

/// Computed in double, because the square of a float may overflow or become zero.
scene::Affine look_at(const LookAt& view) {
  using Eigen::Vector3d;
  const Vector3d z = view.eye.cast<double>() - view.target.cast<double>();
  if (!(z.squaredNorm() > 0.0))
    throw BadOption("--eye and --target are the same point; expected two different ones");
  const Vector3d back = z.normalized();
  const Vector3d up = view.up.cast<double>();
  Vector3d x = up.cross(back);
  // For a view along `up`, any perpendicular vector can be the right one.
  if (!(x.squaredNorm() > 1e-12 * up.squaredNorm())) x = back.unitOrthogonal();
  x.normalize();
  scene::Affine transform = scene::Affine::Identity();
  transform.linear().col(0) = x.cast<float>();
  transform.linear().col(1) = back.cross(x).cast<float>();
  transform.linear().col(2) = back.cast<float>();
  transform.translation() = view.eye;
  return transform;
}

std::string names_of(const scene::Scene& scene) {
  if (scene.cameras.empty()) return "the file has no camera";
  std::string text = "expected one of";
  for (std::size_t i = 0; i < scene.cameras.size(); ++i)
    text += fmt::format(" {} ({})", i, scene.cameras[i].name);
  return text;
}

/// Throws BadOption for a camera that is too far away or shows too much. `named` describes it in the message.
void require_near(const scene::Camera& camera, float aspect, const std::string& named) {
  const scene::Vec3 eye = camera.transform.translation();
  if (!(eye.cwiseAbs().maxCoeff() <= kFurthest)) {
    throw BadOption(fmt::format("{} is at ({:g}, {:g}, {:g}), expected coordinates of at most {:g} m", named,
                                eye.x(), eye.y(), eye.z(), kFurthest));
  }
  const float half = camera.half_height * std::max(1.0f, aspect);
  if (camera.orthographic && !(half <= kFurthest)) {
    throw BadOption(
        fmt::format("{} shows {:g} m to each side, expected at most {:g} m", named, half, kFurthest));
  }
}

scene::Camera find_camera(const scene::Scene& scene, const CameraOptions& options, float aspect) {
  const float fov = options.fov_degrees ? *options.fov_degrees * scene::kPi / 180.0f : 0.0f;
  scene::Camera camera;
  if (options.look_at) {
    camera.name = "look-at";
    camera.transform = look_at(*options.look_at);
    camera.transform.translation() -= scene.origin;
  } else if (!options.name.empty()) {
    const auto& cameras = scene.cameras;
    std::size_t index = static_cast<std::size_t>(
        std::find_if(cameras.begin(), cameras.end(), [&](const auto& c) { return c.name == options.name; }) -
        cameras.begin());
    const char* end = options.name.data() + options.name.size();
    const bool known =
        index < cameras.size() ||
        (std::from_chars(options.name.data(), end, index).ptr == end && index < cameras.size());
    if (!known) {
      throw BadOption(
          fmt::format("--camera {}: no such camera in {}; {}", options.name, scene.path, names_of(scene)));
    }
    camera = cameras[index];
  } else if (!scene.cameras.empty()) {
    camera = scene.cameras.front();
  } else {
    return frame_scene(scene, fov > 0.0f ? fov : camera.vertical_fov, aspect);
  }
  if (fov > 0.0f) camera.vertical_fov = fov;
  return camera;
}

}  // namespace

scene::Camera choose_camera(const scene::Scene& scene, const CameraOptions& options, float aspect) {
  scene::Camera camera = find_camera(scene, options, aspect);
  require_near(camera, aspect,
               options.look_at ? "--eye" : fmt::format("the camera '{}' of {}", camera.name, scene.path));
  return camera;
}

}  // namespace gatelight::renderer

#include "renderer/film/camera_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/nearest_word.h"
#include "base/to_number.h"
#include "renderer/film/framing.h"
#include "scene/shutter.h"

namespace gatelight::renderer {
namespace {

/// In metres. Eyes farther from the origin and larger orthographic pictures are refused: the squares of their
/// distances would leave single precision.
constexpr float kFurthest = 1e12f;

/// Millimetres across the wider side of the picture, as on full-frame film.
constexpr float kSensor = 36.0f;

/// Computed in double, because the square of a float may overflow or become zero.
Affine look_at(const LookAt& view) {
  using Eigen::Vector3d;
  const Vector3d z = view.eye.cast<double>() - view.target.cast<double>();
  if (!(z.squaredNorm() > 0.0)) throw BadOption({"target", "", "it equals `eye`", "another"});
  const Vector3d back = z.normalized();
  const Vector3d up = view.up.cast<double>();
  Vector3d x = up.cross(back);
  // For a view along `up`, any perpendicular vector can be the right one.
  if (!(x.squaredNorm() > 1e-12 * up.squaredNorm())) x = back.unitOrthogonal();
  x.normalize();
  Affine transform = Affine::Identity();
  transform.linear().col(0) = x.cast<float>();
  transform.linear().col(1) = back.cross(x).cast<float>();
  transform.linear().col(2) = back.cast<float>();
  transform.translation() = view.eye;
  return transform;
}

std::string names_of(const scene::Scene& scene) {
  std::string text = scene.cameras.empty() ? "a file with cameras" : "one of";
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const scene::Camera& camera = scene.cameras[i];
    text += fmt::format("{} {} ({}", i == 0 ? "" : ",", i, camera.name);
    if (!camera.node.empty() && camera.node != camera.name) text += fmt::format(", node {}", camera.node);
    text += ")";
  }
  return text;
}

std::string meant(const scene::Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const scene::Camera& camera : scene.cameras) {
    names.push_back(camera.name);
    names.push_back(camera.node);
  }
  return did_you_mean(name, names);
}

/// A name of a camera wins over that of a node, both win over an index.
const scene::Camera& find_named(const scene::Scene& scene, const std::vector<scene::Camera>& cameras,
                                const std::string& name) {
  for (std::string scene::Camera::*member : {&scene::Camera::name, &scene::Camera::node}) {
    const auto has_name = [&](const scene::Camera& camera) { return camera.*member == name; };
    const auto found = std::find_if(cameras.begin(), cameras.end(), has_name);
    if (found == cameras.end()) continue;
    if (std::find_if(found + 1, cameras.end(), has_name) != cameras.end())
      throw BadOption(
          {"camera", name, fmt::format("is the name of several cameras in {}", scene.path), names_of(scene)});
    return *found;
  }
  const std::size_t index = to_number<std::size_t>(name).value_or(cameras.size());
  if (index >= cameras.size())
    throw BadOption({"camera", name, fmt::format("is not a camera of {}", scene.path), names_of(scene),
                     meant(scene, name)});
  return cameras[index];
}

/// Throws BadOption for a camera that is too far away or shows too much. `named` describes it in the message.
void require_near(const scene::Camera& camera, float aspect, const char* option, const std::string& named) {
  const Vec3 eye = camera.transform.translation();
  if (!(eye.cwiseAbs().maxCoeff() <= kFurthest)) {
    throw BadOption({option, "", fmt::format("{} is at ({:g}, {:g}, {:g})", named, eye.x(), eye.y(), eye.z()),
                     fmt::format("coordinates of at most {:g} m", kFurthest)});
  }
  const float half = camera.half_height * std::max(1.0f, aspect);
  if (camera.orthographic && !(half <= kFurthest)) {
    throw BadOption({option, "", fmt::format("{} shows {:g} m to each side", named, half),
                     fmt::format("at most {:g} m", kFurthest)});
  }
}

scene::Camera find_camera(const scene::Scene& scene, const std::vector<scene::Camera>& cameras,
                          const CameraOptions& options, float fov, float aspect) {
  scene::Camera camera;
  if (options.look_at) {
    camera.name = "look-at";
    camera.transform = look_at(*options.look_at);
    camera.transform.translation() -= scene.origin;
    return camera;
  }
  if (options.index) return cameras.at(*options.index);
  if (!options.name.empty()) return find_named(scene, cameras, options.name);
  if (!cameras.empty()) return cameras.front();
  return frame_scene(scene, fov > 0.0f ? fov : camera.vertical_fov, aspect);
}

/// The vertical field of view that the options set, in radians; 0: none.
float chosen_fov(const CameraOptions& options, float aspect) {
  if (options.fov_degrees) return *options.fov_degrees * kPi / 180.0f;
  if (!options.focal_mm) return 0.0f;
  return 2.0f * std::atan(0.5f * kSensor / (*options.focal_mm * std::max(1.0f, aspect)));
}

float distance_to_subject(const scene::Scene& scene, const CameraOptions& options, const View& view) {
  if (options.look_at) return (options.look_at->eye - options.look_at->target).norm();
  return scene.bounds.isEmpty() ? 1.0f : (scene.bounds.center() - view.transform.translation()).norm();
}

void project(const scene::Scene& scene, const CameraOptions& options, View& view) {
  const bool has_angle = !view.orthographic && options.projection != Projection::panorama;
  if (!has_angle && (options.fov_degrees || options.focal_mm))
    throw BadOption({options.fov_degrees ? "fov" : "lens", "",
                     fmt::format("the view is {}", view.orthographic ? "orthographic" : "a panorama"),
                     "a perspective one"});
  if (options.projection == Projection::orthographic && !view.orthographic) {
    // The subject is as large as in the perspective view.
    view.half_height = distance_to_subject(scene, options, view) * std::tan(0.5f * view.vertical_fov);
    view.half_width = 0.0f;
  }
  if (options.projection != Projection::camera)
    view.orthographic = options.projection == Projection::orthographic;
  view.panorama = options.projection == Projection::panorama;
  if (!options.view_height) return;
  if (!view.orthographic)
    throw BadOption({"view-height", "", "the view is not orthographic", "`projection` orthographic"});
  view.half_height = 0.5f * *options.view_height;
}

Box bounds_of(const scene::Scene& scene, const scene::Instance& instance) {
  Box box;
  for (const Vec3& p : scene.mesh_of(instance).positions) box.extend(Vec3(instance.transform * p));
  return box;
}

/// The focus distance in metres along the view direction; 0 if `focus` is empty.
float focus_distance(const scene::Scene& scene, const std::string& focus, const View& view) {
  if (focus.empty()) return 0.0f;
  std::optional<float> distance = to_number<float>(focus);
  if (!distance) {
    Box box;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
      if (scene.instances[i].name == focus) box.extend(bounds_of(scene, scene.instances[i]));
    }
    if (box.isEmpty())
      throw BadOption({"focus", focus, fmt::format("is not an object of {}", scene.path), "one, or metres"});
    distance = (box.center() - view.transform.translation()).dot(-view.transform.linear().col(2));
    if (!(*distance > 0.0f))
      throw BadOption({"focus", focus, fmt::format("is behind the camera '{}'", view.name)});
  }
  if (!(*distance > 0.0f && *distance <= kFurthest))
    throw BadOption(
        {"focus", focus, "", fmt::format("a node, or metres above 0 and at most {:g}", kFurthest)});
  return *distance;
}

void set_lens(const scene::Scene& scene, const LensOptions& lens, float aspect, View& view) {
  const bool any = lens.aperture > 0.0f || lens.f_stop > 0.0f;
  if (!any) return;
  if (view.orthographic || view.panorama)
    throw BadOption({"aperture", "", "the view has no lens", "`projection` perspective"});
  // The focal length that shows this field of view on a sensor of 36 mm.
  const float focal = 0.5e-3f * kSensor / (std::tan(0.5f * view.vertical_fov) * std::max(1.0f, aspect));
  view.lens_radius = 0.5f * (lens.f_stop > 0.0f ? focal / lens.f_stop : lens.aperture);
  view.focus_distance = focus_distance(scene, lens.focus, view);
  view.blades = lens.blades;
}

/// A view of the same subject from another side.
void turn_around(const scene::Scene& scene, const CameraOptions& options, View& view) {
  if (options.turn == 0.0f) return;
  const Vec3 axis = options.look_at ? Vec3(options.look_at->up.normalized()) : Vec3(0.0f, 1.0f, 0.0f);
  Vec3 center = scene.bounds.isEmpty() ? Vec3(Vec3::Zero()) : scene.bounds.center();
  if (options.look_at) center = options.look_at->target - scene.origin;
  Affine turn = Affine::Identity();
  turn.translate(center);
  turn.rotate(Eigen::AngleAxisf(options.turn, axis));
  turn.translate(-center);
  view.transform = turn * view.transform;
}

/// `cameras`: those of the scene, perhaps at another time.
View choose_camera(const scene::Scene& scene, const std::vector<scene::Camera>& cameras,
                   const CameraOptions& options, float aspect) {
  const float fov = chosen_fov(options, aspect);
  View view = find_camera(scene, cameras, options, fov, aspect);
  if (fov > 0.0f) view.vertical_fov = fov;
  project(scene, options, view);
  require_near(view, aspect, options.look_at ? "eye" : "camera",
               options.look_at ? "it" : fmt::format("'{}' of {}", view.name, scene.path));
  turn_around(scene, options, view);
  set_lens(scene, options.lens, aspect, view);
  const auto& [near, far] = view.clip = options.clip;
  if (!(near >= 0.0f && near < far))
    throw BadOption({"clip", fmt::format("{},{}", near, far), "", "NEAR,FAR in metres, 0 <= NEAR < FAR"});
  return view;
}

/// The number of states for what turns by this angle while the shutter is open.
std::size_t states_of_turn(const std::vector<float>& clock, float turn) {
  const int intervals = clock.empty() ? scene::kShutterKeys - 1 : static_cast<int>(clock.size()) - 1;
  float longest = clock.empty() ? 1.0f / static_cast<float>(intervals) : 0.0f;
  for (std::size_t i = 1; i < clock.size(); ++i) longest = std::max(longest, clock[i] - clock[i - 1]);
  const int parts = scene::parts_of_turn(static_cast<double>(longest * std::abs(turn)), intervals);
  return static_cast<std::size_t>(intervals * parts + 1);
}

}  // namespace

View choose_camera(const scene::Scene& scene, const CameraOptions& options, float aspect) {
  return choose_camera(scene, scene.cameras, options, aspect);
}

std::vector<View> shutter_views(const scene::Scene& scene, const CameraOptions& options, float aspect,
                                const View& view) {
  const std::vector<std::vector<scene::Camera>>& cameras = scene.shutter.cameras;
  const std::vector<float>& clock = scene.shutter.clock;
  const bool any =
      std::any_of(cameras.begin(), cameras.end(), [](const auto& states) { return !states.empty(); });
  if (!scene.shutter.is_open || (!any && options.turn_in_shutter == 0.0f)) return {};
  std::size_t count = states_of_turn(clock, options.turn_in_shutter);
  for (const std::vector<scene::Camera>& states : cameras) count = std::max(count, states.size());
  std::vector<View> views;
  CameraOptions moved = options;
  for (std::size_t state = 0; state < count; ++state) {
    const float time = scene::time_of_state(state, count);
    moved.turn =
        options.turn + (scene::clock_at(clock, time) - scene::kShutterMiddle) * options.turn_in_shutter;
    std::vector<scene::Camera> now = scene.cameras;
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (!cameras[i].empty()) now[i] = scene::camera_at(cameras[i], time);
    }
    views.push_back(choose_camera(scene, now, moved, aspect));
    views.back().focus_distance = view.focus_distance;
  }
  return views;
}

}  // namespace gatelight::renderer

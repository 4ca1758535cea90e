#include <pybind11/stl.h>

#include <cmath>
#include <utility>

#include "apps/python/fields.h"
#include "apps/reports/scene_report.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;
using scene::LightType;
using scene::PunctualLight;

constexpr apps::RealRange kIntensity{0.0, 3.4e38};
constexpr apps::RealRange kReach{.min = 0.0, .max = 3.4e38, .excludes_min = true, .infinity = true};
constexpr apps::RealRange kAngle{0.0, 90.0};
constexpr apps::RealRange kFov{0.001, 179.9};
constexpr float kDegree = kPi / 180.0f;

float degrees_of(float cosine) {
  return std::acos(std::min(cosine, 1.0f)) / kDegree;
}

const std::vector<Field<PunctualLight>>& light_fields() {
  using L = PunctualLight;
  static const std::vector<Field<L>> fields = {
      {"name", &L::name, {}, "Name, for lights and light_groups"},
      {"intensity", &L::intensity, kIntensity,
       "Linear RGB or one number: W/sr (point, spot) or W/m2 (directional)"},
      {"position", &L::position, {}, "Metres, in the world"},
      {"direction", [](const L& l) -> py::object { return tuple_of(l.direction.array()); },
       [](L& l, py::handle v) { l.direction = direction("direction", v); },
       "Direction in which light travels, in the world"},
      {"range", &L::range, kReach, "Metres; inf: no end"},
      {"inner_angle", [](const L& l) -> py::object { return py::float_(degrees_of(l.cos_inner)); },
       [](L& l, py::handle v) { l.cos_inner = std::cos(kDegree * number("inner_angle", v, kAngle)); },
       "Degrees from the axis of a spot to where its light begins to fall"},
      {"outer_angle", [](const L& l) -> py::object { return py::float_(degrees_of(l.cos_outer)); },
       [](L& l, py::handle v) { l.cos_outer = std::cos(kDegree * number("outer_angle", v, kAngle)); },
       "Degrees from the axis of a spot to its edge"},
  };
  return fields;
}

const std::vector<Field<scene::Camera>>& camera_fields() {
  static const std::vector<Field<scene::Camera>> fields = {
      {"name", &scene::Camera::name, {}, "Name, for the option camera"},
      {"transform", [](const scene::Camera& c) { return matrix_of(c.transform); },
       [](scene::Camera& c, py::handle v) { c.transform = transform("transform", v); },
       "(4, 4), camera to world without scale; the camera looks along -z with y up"},
      {"fov", [](const scene::Camera& c) -> py::object { return py::float_(c.vertical_fov / kDegree); },
       [](scene::Camera& c, py::handle v) { c.vertical_fov = kDegree * number("fov", v, kFov); },
       "Degrees, vertical, of a perspective camera"},
      {"view_height",
       [](const scene::Camera& c) -> py::object {
         return c.orthographic ? py::object(py::float_(2.0f * c.half_height)) : py::none();
       },
       [](scene::Camera& c, py::handle v) {
         c.orthographic = !v.is_none();
         const apps::RealRange heights{.max = 2e12, .excludes_min = true};
         if (c.orthographic) c.half_height = 0.5f * number("view_height", v, heights);
         c.half_width = 0.0f;
       },
       "Metres: makes the camera orthographic; None: perspective"},
  };
  return fields;
}

/// The view of `eye`, `target` and `up`, as --eye has it.
Affine look_at(const Vec3& eye, const Vec3& target, const Vec3& up) {
  const Vec3 back = (eye - target).stableNormalized();
  const Vec3 right = up.cross(back).stableNormalized();
  if (!right.allFinite() || right.squaredNorm() < 0.5f)
    throw BadOption({"up", "", "it is parallel to the view, or target equals eye", "another direction"});
  Affine transform = Affine::Identity();
  transform.linear().col(0) = right;
  transform.linear().col(1) = back.cross(right);
  transform.linear().col(2) = back;
  transform.translation() = eye;
  return transform;
}

}  // namespace

LightPart make_light(const ScenePointer& scene, const std::string& type, const py::kwargs& keywords) {
  PunctualLight light;
  light.type = apps::parse_choice("type", type, apps::kLightTypes);
  set_members(light_fields(), "Light", scene, light, keywords);
  if (light.type == LightType::spot && light.cos_inner < light.cos_outer)
    throw BadOption({"inner_angle", "", "it is larger than outer_angle", "at most that"});
  return LightPart::add(scene, std::move(light));
}

CameraPart make_camera(const ScenePointer& scene, const py::kwargs& keywords) {
  scene::Camera camera;
  py::dict members(keywords);
  const auto take = [&](const char* name) -> py::object {
    return members.contains(name) ? members.attr("pop")(name).cast<py::object>() : py::none();
  };
  const py::object eye = take("eye"), target = take("target"), up = take("up");
  if (eye.is_none() != target.is_none())
    throw BadOption({eye.is_none() ? "eye" : "target", "", "it is missing", "eye and target"});
  if (!eye.is_none())
    camera.transform = look_at(vector("eye", eye), vector("target", target),
                               up.is_none() ? Vec3(0.0f, 1.0f, 0.0f) : vector("up", up));
  set_members(camera_fields(), "Camera", scene, camera, members);
  return CameraPart::add(scene, std::move(camera));
}

void add_views(py::module_& module) {
  add_part_class<LightPart>(module, "Light", "A point, spot or directional light.", light_fields())
      .def_property_readonly("type", [](const LightPart& part) {
        return std::string(renderer::name_of(apps::kLightTypes, part->type));
      });
  add_part_class<CameraPart>(module, "Camera", "A camera of a scene, chosen by the option camera.",
                             camera_fields());
}

}  // namespace gatelight::python

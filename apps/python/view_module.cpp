#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cmath>
#include <functional>

#include "apps/python/conversions.h"
#include "apps/python/keywords.h"
#include "apps/python/scene_parts.h"
#include "base/errors.h"
#include "base/nearest_word.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;
using scene::LightType;
using scene::PunctualLight;

constexpr renderer::Choice<LightType> kTypes[] = {
    {"directional", LightType::directional}, {"point", LightType::point}, {"spot", LightType::spot}};
constexpr apps::RealRange kIntensity{0.0, 3.4e38};
constexpr apps::RealRange kReach{.min = 0.0, .max = 3.4e38, .excludes_min = true, .infinity = true};
constexpr apps::RealRange kAngle{0.0, 90.0};
constexpr apps::RealRange kFov{0.001, 179.9};
constexpr float kDegree = kPi / 180.0f;

/// A member of an object by its name in Python.
template <class Object>
struct Field {
  const char* name;
  std::function<py::object(const Object&)> get;
  std::function<void(Object&, py::handle)> set;
  const char* help;
};

float degrees_of(float cosine) {
  return std::acos(std::min(cosine, 1.0f)) / kDegree;
}

using LightField = Field<PunctualLight>;
using CameraField = Field<scene::Camera>;

const std::vector<LightField>& light_fields() {
  static const std::vector<LightField> fields = {
      {"name", [](const PunctualLight& l) -> py::object { return py::str(l.name); },
       [](PunctualLight& l, py::handle v) { l.name = text_of("name", v); },
       "Name, for lights and light_groups"},
      {"intensity", [](const PunctualLight& l) -> py::object { return tuple_of(l.intensity); },
       [](PunctualLight& l, py::handle v) { l.intensity = color("intensity", v, kIntensity); },
       "Linear RGB or one number: W/sr (point, spot) or W/m2 (directional)"},
      {"position", [](const PunctualLight& l) -> py::object { return tuple_of(l.position.array()); },
       [](PunctualLight& l, py::handle v) { l.position = vector("position", v); }, "Metres, in the world"},
      {"direction", [](const PunctualLight& l) -> py::object { return tuple_of(l.direction.array()); },
       [](PunctualLight& l, py::handle v) { l.direction = direction("direction", v); },
       "The way that light travels, in the world"},
      {"range", [](const PunctualLight& l) -> py::object { return py::float_(l.range); },
       [](PunctualLight& l, py::handle v) { l.range = number("range", v, kReach); }, "Metres; inf: no end"},
      {"inner_angle",
       [](const PunctualLight& l) -> py::object { return py::float_(degrees_of(l.cos_inner)); },
       [](PunctualLight& l, py::handle v) {
         l.cos_inner = std::cos(kDegree * number("inner_angle", v, kAngle));
       },
       "Degrees from the axis of a spot to where its light begins to fall"},
      {"outer_angle",
       [](const PunctualLight& l) -> py::object { return py::float_(degrees_of(l.cos_outer)); },
       [](PunctualLight& l, py::handle v) {
         l.cos_outer = std::cos(kDegree * number("outer_angle", v, kAngle));
       },
       "Degrees from the axis of a spot to its edge"},
  };
  return fields;
}

const std::vector<CameraField>& camera_fields() {
  static const std::vector<CameraField> fields = {
      {"name", [](const scene::Camera& c) -> py::object { return py::str(c.name); },
       [](scene::Camera& c, py::handle v) { c.name = text_of("name", v); }, "Name, for the option camera"},
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

template <class Object>
void set_members(const std::vector<Field<Object>>& fields, const char* what, Object& object,
                 const py::dict& keywords) {
  std::vector<std::string> names;
  for (const Field<Object>& field : fields) names.emplace_back(field.name);
  for (const auto& [key, value] : keywords) {
    const std::string name = py::str(key);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      throw BadOption({name, "", fmt::format("{} has no such member", what),
                       fmt::format("one of gatelight.{}", what), did_you_mean(name, names)});
    const Field<Object>& field = fields[static_cast<std::size_t>(found - names.begin())];
    field.set(object, value);
  }
}

template <class PartOf, class Object>
void add_fields(py::class_<PartOf>& type, const std::vector<Field<Object>>& fields,
                std::vector<Object> scene::Scene::*list) {
  type.def_property_readonly("index", [](const PartOf& part) { return part.index; });
  for (const Field<Object>& field : fields) {
    type.def_property(
        field.name,
        [&field, list](const PartOf& part) { return field.get((part.scene->source.*list)[part.index]); },
        [&field, list](const PartOf& part, const py::object& value) {
          field.set((part.scene->source.*list)[part.index], value);
          part.scene->change();
        },
        field.help);
  }
}

/// The view of `eye`, `target` and `up`, as --eye has it.
Affine look_at(const Vec3& eye, const Vec3& target, const Vec3& up) {
  const Vec3 back = (eye - target).stableNormalized();
  const Vec3 right = up.cross(back).stableNormalized();
  if (!right.allFinite() || right.squaredNorm() < 0.5f)
    throw BadOption(
        {"up", "", "it is parallel to the view, or target is the place of eye", "another direction"});
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
  light.type = apps::parse_choice("type", type, kTypes);
  set_members(light_fields(), "Light", light, keywords);
  if (light.type == LightType::spot && light.cos_inner < light.cos_outer)
    throw BadOption({"inner_angle", "", "it is larger than outer_angle", "at most that"});
  scene->source.lights.push_back(std::move(light));
  scene->change();
  return {{scene, scene->source.lights.size() - 1}};
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
  set_members(camera_fields(), "Camera", camera, members);
  scene->source.cameras.push_back(std::move(camera));
  scene->change();
  return {{scene, scene->source.cameras.size() - 1}};
}

void add_views(py::module_& module) {
  py::class_<LightPart> light(module, "Light", "A point, spot or directional light.");
  light.def("__repr__", [](const LightPart& part) {
    return fmt::format("<gatelight.Light '{}'>", part.scene->source.lights[part.index].name);
  });
  light.def_property_readonly("type", [](const LightPart& part) {
    return std::string(renderer::name_of(kTypes, part.scene->source.lights[part.index].type));
  });
  add_fields(light, light_fields(), &scene::Scene::lights);
  py::class_<CameraPart> camera(module, "Camera", "A camera of a scene, chosen by the option camera.");
  camera.def("__repr__", [](const CameraPart& part) {
    return fmt::format("<gatelight.Camera {} '{}'>", part.index, part.scene->source.cameras[part.index].name);
  });
  add_fields(camera, camera_fields(), &scene::Scene::cameras);
}

}  // namespace gatelight::python

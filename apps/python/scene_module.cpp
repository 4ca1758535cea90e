#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>

#include "apps/python/arrays.h"
#include "apps/python/module.h"
#include "apps/python/scene_parts.h"
#include "base/errors.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;

void show(const ScenePointer& scene, double seconds) {
  if (!scene->file || !scene->loading.load.time)
    throw BadOption({"time", "", "the scene was loaded without one", "gatelight.load(path, time=...)"});
  if (!std::isfinite(seconds)) throw BadOption({"time", fmt::format("{}", seconds), "", "a finite number"});
  scene->shown = seconds;
  scene->change();
}

py::object bounds_of(const ScenePointer& scene) {
  const Box box = finished_scene(scene)->bounds;
  if (box.isEmpty()) return py::none();
  py::array_t<float> bounds({2, 3});
  auto b = bounds.mutable_unchecked<2>();
  for (py::ssize_t axis = 0; axis < 3; ++axis) {
    b(0, axis) = box.min()[axis];
    b(1, axis) = box.max()[axis];
  }
  return bounds;
}

void add_lists(py::class_<SceneData, ScenePointer>& scene) {
  scene.def_property_readonly("materials", &MaterialPart::all);
  scene.def_property_readonly("meshes", &MeshPart::all);
  scene.def_property_readonly("instances", &InstancePart::all);
  scene.def_property_readonly("lights", &LightPart::all);
  scene.def_property_readonly("cameras", &CameraPart::all);
  scene.def_property_readonly("textures", &TexturePart::all);
}

void add_facts(py::class_<SceneData, ScenePointer>& scene) {
  scene.def_property_readonly("path", [](const ScenePointer& s) { return s->source.path; });
  scene.def_property_readonly("variants", [](const ScenePointer& s) { return s->source.variants; });
  scene.def_property_readonly(
      "animations",
      [](const ScenePointer& s) {
        py::list list;
        for (const scene::Animation& animation : s->source.animations)
          list.append(py::make_tuple(animation.name, animation.seconds));
        return list;
      },
      "Name and seconds of each animation of the file");
  scene.def_property_readonly(
      "warnings", [](const ScenePointer& s) { return finished_scene(s)->warnings; },
      "One line for each part of the file that could not be used as given");
  scene.def_property_readonly(
      "triangles", [](const ScenePointer& s) { return scene::count_triangles(s->source); },
      "Number of triangles, counted once per instance");
  scene.def_property_readonly("bounds", bounds_of,
                              "(2, 3) float32: least and greatest corner in metres; None: empty");
  scene.def_property_readonly(
      "origin",
      [](const ScenePointer& s) {
        const Vec3& o = s->source.origin;
        return py::make_tuple(o.x(), o.y(), o.z());
      },
      "Position of the world's origin in the file's coordinates; not zero if the scene is far from the "
      "file's origin");
}

}  // namespace

void add_scene(py::module_& module) {
  py::class_<SceneData, ScenePointer> scene(
      module, "Scene",
      "Meshes, instances, materials, lights and cameras. A new scene is empty; gatelight.load() reads one. "
      "The unit is the metre, y is up. Changes apply from the next render on.");
  add_geometry(module);
  add_views(module);
  scene.def(py::init([] { return std::make_shared<SceneData>(); }));
  scene.def(
      "add_material", make_material,
      "Adds a material; keywords are the members of gatelight.Material. The default is that of glTF: white, "
      "metallic 1, roughness 1.");
  scene.def("add_texture", make_texture, py::arg("image"), py::kw_only(), py::arg("wrap") = "repeat",
            py::arg("nearest") = false, py::arg("name") = "",
            "Adds a texture from an array (h, w) or (h, w, 1 to 4) of uint8, rows from the top; wrap is "
            "repeat, mirror "
            "or clamp.");
  scene.def("add_mesh", make_mesh, py::arg("positions"), py::arg("triangles"),
            py::arg("normals") = py::none(), py::arg("uvs") = py::none(), py::arg("material") = py::none(),
            py::arg("name") = "", py::arg("colors") = py::none(),
            "Adds a mesh: positions (n, 3) in metres, triangles (m, 3) of indices, counter-clockwise from "
            "the front, normals (n, 3) or None for flat ones, uvs (n, 2), colors (n, 3) or (n, 4), linear, "
            "that multiply the material's base colour.");
  scene.def("add_instance", make_instance, py::arg("mesh"), py::arg("transform") = py::none(),
            py::arg("name") = "",
            "Places a mesh in the world: transform (4, 4) for column vectors, None: identity.");
  scene.def("add_light", make_light, py::arg("type"),
            "Adds a light of type point, spot or directional; keywords are the members of gatelight.Light.");
  scene.def("add_camera", make_camera,
            "Adds a camera; keywords are the members of gatelight.Camera, or eye, target and up for its "
            "transform.");
  scene.def("show", show, py::arg("seconds"),
            "Shows another time of the animations of a file that was loaded with a time.");
  scene.def("__repr__", [](const ScenePointer& s) {
    const scene::Scene& source = s->source;
    return fmt::format("<gatelight.Scene{}, {} meshes, {} instances, {} lights>",
                       source.path.empty() ? "" : fmt::format(" '{}'", source.path), source.meshes.size(),
                       source.instances.size(), source.lights.size());
  });
  add_lists(scene);
  add_facts(scene);
  module.def("load", load_scene, py::arg("path"), py::arg("options"));
}

}  // namespace gatelight::python

#include <pybind11/stl.h>

#include "apps/python/frames.h"
#include "apps/python/module.h"
#include "apps/python/running.h"

namespace gatelight::python {

namespace py = pybind11;

void add_renderer(py::module_& module) {
  py::class_<Running> renderer(module, "Renderer",
                               "Renders one scene several times. Its data (the acceleration structure, "
                               "lights, textures) is kept until the scene changes.");
  renderer.def(py::init([](const ScenePointer& scene, const py::kwargs& options) {
                 return std::make_unique<Running>(scene, options);
               }),
               py::arg("scene"), "Options are those of gatelight.render.");
  renderer.def("render", &Running::render, py::kw_only(), py::arg("progress") = py::none(),
               py::arg("stop") = py::none(),
               "Renders a picture. If another thread calls stop(), it is the picture so far.");
  renderer.def(
      "set_camera", [](Running& running, const py::kwargs& view) { running.set_camera(view); },
      "Changes the view of the next pictures: camera, eye, target, up, fov, lens, projection, view_height, "
      "aperture, focus, blades, view_file. Nothing is rebuilt.");
  renderer.def(
      "set_options", [](Running& running, const py::kwargs& options) { running.set_options(options); },
      "Changes options of the next pictures; other options keep their values. None sets the default. Only "
      "data that depends on the changed options is rebuilt.");
  renderer.def("stop", &Running::stop, "Ends the current render of another thread.");
  renderer.def_property_readonly("scene", &Running::scene);

  py::class_<Frames> frames(module, "Frames", "An iterator over the frames of an animation.");
  frames.def(py::init([](const ScenePointer& scene, const py::dict& options, const py::object& progress,
                         const py::object& stop) {
               return std::make_unique<Frames>(scene, options, progress, stop);
             }),
             py::arg("scene"), py::arg("options"), py::arg("progress"), py::arg("stop"));
  frames.def("__iter__", [](py::object self) { return self; });
  frames.def("__next__", &Frames::next);
  frames.def("__len__", &Frames::size);
}

}  // namespace gatelight::python

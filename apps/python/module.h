#pragma once
// The parts of the module.

#include <pybind11/pybind11.h>

namespace gatelight::python {

/// Adds gatelight.Error, and makes it of every exception of ours that a function of the module throws.
void add_error(pybind11::module_& module);
void add_materials(pybind11::module_& module);
void add_scene(pybind11::module_& module);
void add_picture(pybind11::module_& module);
void add_renderer(pybind11::module_& module);
void add_frames(pybind11::module_& module);
void add_metrics(pybind11::module_& module);
void add_cache(pybind11::module_& module);

}  // namespace gatelight::python

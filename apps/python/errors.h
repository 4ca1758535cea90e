#pragma once
// gatelight.Error: the exceptions of the libraries in Python.

#include <pybind11/pybind11.h>

namespace gatelight::python {

/// Adds the class, and makes it of every exception of ours that a function of the module throws.
void add_error(pybind11::module_& module);

}  // namespace gatelight::python

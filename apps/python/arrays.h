#pragma once
// Arrays of NumPy in and out.

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/errors.h"

namespace gatelight::python {

template <class Number>
using Array = pybind11::array_t<Number, pybind11::array::c_style>;

inline std::string shape_of(const pybind11::array& array) {
  std::string text;
  for (pybind11::ssize_t i = 0; i < array.ndim(); ++i)
    text += fmt::format("{}{}", i > 0 ? ", " : "", array.shape(i));
  return fmt::format("({}{})", text, array.ndim() == 1 ? "," : "");
}

/// Converts an object to an array of rows of `columns` numbers (0: one number each, a plain list). Throws
/// BadOption, which names it, for other shapes and for numbers that the type cannot hold.
template <class Number>
Array<Number> rows(const char* name, pybind11::handle values, pybind11::ssize_t columns) {
  namespace py = pybind11;
  const py::array given = py::array::ensure(values);
  const bool fits =
      given && (columns > 0 ? given.ndim() == 2 && given.shape(1) == columns : given.ndim() == 1);
  const std::string expected = columns > 0 ? fmt::format("(n, {})", columns) : "(n,)";
  if (!given) {
    PyErr_Clear();
    throw BadOption({name, "", "it is no array", fmt::format("one of shape {}", expected)});
  }
  if (!fits) throw BadOption({name, shape_of(given), "is the array's shape", expected});
  const char kind = given.dtype().kind();
  const bool integers = std::is_integral_v<Number>;
  if (integers ? kind != 'i' && kind != 'u' : kind != 'f' && kind != 'i' && kind != 'u')
    throw BadOption({name, std::string(py::str(given.dtype())), "is the array's type",
                     integers ? "integers" : "numbers"});
  if (integers && given.size() > 0) {
    const py::object least = given.attr("min")(), greatest = given.attr("max")();
    if (py::int_(least).cast<double>() < 0.0 || py::int_(greatest).cast<double>() > 4294967295.0)
      throw BadOption({name, std::string(py::str(py::int_(least).cast<double>() < 0.0 ? least : greatest)),
                       "", "from 0 to 4294967295"});
  }
  return Array<Number>(
      py::reinterpret_borrow<py::object>(given.attr("astype")(py::dtype::of<Number>(), "C")));
}

/// A view of rows that an owner keeps alive; (n, columns), or (n,) with 0 columns.
template <class Number>
pybind11::array view(const Number* data, pybind11::ssize_t count, pybind11::ssize_t columns,
                     const pybind11::object& owner) {
  namespace py = pybind11;
  std::vector<py::ssize_t> shape = {count};
  if (columns > 0) shape.push_back(columns);
  py::array array(py::dtype::of<Number>(), shape, data, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

}  // namespace gatelight::python

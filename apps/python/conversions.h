#pragma once
// Small values of Python as those of a scene. Each function throws BadOption, which names the value.

#include <pybind11/pybind11.h>

#include <array>
#include <optional>
#include <string>

#include "apps/settings/parsing.h"
#include "base/math.h"

namespace gatelight::python {

float number(const char* name, pybind11::handle value, const apps::RealRange& range);
/// Three numbers, or one for all.
std::array<float, 3> triple(const char* name, pybind11::handle value, const apps::RealRange& range);

inline Color color(const char* name, pybind11::handle value, const apps::RealRange& range) {
  const std::array<float, 3> v = triple(name, value, range);
  return {v[0], v[1], v[2]};
}
inline Vec3 vector(const char* name, pybind11::handle value) {
  const std::array<float, 3> v = triple(name, value, apps::kAnyFloat);
  return {v[0], v[1], v[2]};
}
/// A direction of length 1.
Vec3 direction(const char* name, pybind11::handle value);

pybind11::tuple tuple_of(const Eigen::Ref<const Eigen::Array3f>& v);

/// A matrix of 4 x 4 or 3 x 4 numbers, for column vectors.
Affine transform(const char* name, pybind11::handle value);
pybind11::object matrix_of(const Affine& transform);

}  // namespace gatelight::python

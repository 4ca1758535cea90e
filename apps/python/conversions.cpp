#include "apps/python/conversions.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include "apps/python/arrays.h"
#include "apps/python/keywords.h"

namespace gatelight::python {

namespace py = pybind11;

float number(const char* name, py::handle value, const apps::RealRange& range) {
  return apps::parse_float(name, text_of(name, value), range);
}

std::array<float, 3> triple(const char* name, py::handle value, const apps::RealRange& range) {
  std::string text = text_of(name, value);
  if (!text.empty() && text.find(',') == std::string::npos) text = fmt::format("{0},{0},{0}", text);
  return apps::parse_triple(name, text, range);
}

Vec3 direction(const char* name, py::handle value) {
  Vec3 v = vector(name, value);
  v.stableNormalize();
  if (!v.allFinite() || v.squaredNorm() < 0.5f)
    throw BadOption({name, text_of(name, value), "is not a direction", "a vector that is not zero"});
  return v;
}

py::tuple tuple_of(const Eigen::Ref<const Eigen::Array3f>& v) {
  return py::make_tuple(v[0], v[1], v[2]);
}

Affine transform(const char* name, py::handle value) {
  const Array<double> matrix = rows<double>(name, value, 4);
  const auto m = matrix.unchecked<2>();
  if (m.shape(0) != 4 && m.shape(0) != 3)
    throw BadOption({name, shape_of(matrix), "is the array's shape", "(4, 4) or (3, 4)"});
  Affine result;
  for (py::ssize_t row = 0; row < m.shape(0); ++row) {
    for (py::ssize_t column = 0; column < 4; ++column) {
      const double x = m(row, column);
      if (row == 3) {
        if (x == (column == 3 ? 1.0 : 0.0)) continue;
        throw BadOption({name, "", fmt::format("{} in its last row", x), "0, 0, 0, 1"});
      }
      const auto rounded = static_cast<float>(x);
      if (!std::isfinite(rounded))
        throw BadOption({name, "", fmt::format("{} in row {}", x, row), "finite numbers"});
      result.matrix()(row, column) = rounded;
    }
  }
  return result;
}

py::object matrix_of(const Affine& transform) {
  py::array_t<float> matrix({4, 4});
  auto m = matrix.mutable_unchecked<2>();
  for (py::ssize_t row = 0; row < 4; ++row) {
    for (py::ssize_t column = 0; column < 4; ++column)
      m(row, column) = row < 3 ? transform.matrix()(row, column) : column == 3 ? 1.0f : 0.0f;
  }
  return matrix;
}

}  // namespace gatelight::python

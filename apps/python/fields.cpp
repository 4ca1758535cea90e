#include "apps/python/fields.h"

#include <cmath>

#include "apps/python/arrays.h"
#include "apps/python/keywords.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;

constexpr renderer::Choice<scene::AlphaMode> kAlphaModes[] = {{"opaque", scene::AlphaMode::opaque},
                                                              {"mask", scene::AlphaMode::mask},
                                                              {"blend", scene::AlphaMode::blend}};

}  // namespace

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

py::object get_value(const ScenePointer&, const Color& value) {
  return tuple_of(value);
}
py::object get_value(const ScenePointer&, const Vec3& value) {
  return tuple_of(value.array());
}
py::object get_value(const ScenePointer&, const scene::AlphaMode& value) {
  return py::str(renderer::name_of(kAlphaModes, value));
}
py::object get_value(const ScenePointer& scene, const scene::TextureSlot& value) {
  if (!value) return py::none();
  return py::cast(TexturePart{scene, static_cast<std::size_t>(value.texture)});
}

void set_value(float& member, const NewValue& given) {
  member = number(given.name, given.value, given.range);
}
void set_value(bool& member, const NewValue& given) {
  if (!py::isinstance<py::bool_>(given.value))
    throw BadOption({given.name, text_of(given.name, given.value), "", "True or False"});
  member = given.value.cast<bool>();
}
void set_value(Color& member, const NewValue& given) {
  member = color(given.name, given.value, given.range);
}
void set_value(Vec3& member, const NewValue& given) {
  member = vector(given.name, given.value);
}
void set_value(std::string& member, const NewValue& given) {
  member = text_of(given.name, given.value);
}
void set_value(scene::AlphaMode& member, const NewValue& given) {
  member = apps::parse_choice(given.name, text_of(given.name, given.value), kAlphaModes);
}
void set_value(scene::TextureSlot& member, const NewValue& given) {
  if (given.value.is_none()) {
    member = {};
  } else {
    member = {.texture = index_of<TexturePart>(given.scene, given.name, given.value, "texture",
                                               "one of scene.add_texture or None")};
  }
}

}  // namespace gatelight::python

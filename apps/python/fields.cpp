#include "apps/python/fields.h"

#include "apps/python/conversions.h"
#include "apps/python/keywords.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;

constexpr renderer::Choice<scene::AlphaMode> kAlphaModes[] = {{"opaque", scene::AlphaMode::opaque},
                                                              {"mask", scene::AlphaMode::mask},
                                                              {"blend", scene::AlphaMode::blend}};

}  // namespace

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

#pragma once
// Members of a part of a scene by their names in Python, and small values of Python as those of a scene.

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "apps/python/scene_parts.h"
#include "apps/settings/parsing.h"
#include "base/errors.h"
#include "base/math.h"
#include "base/nearest_word.h"

namespace gatelight::python {

// Each throws BadOption, which names the value.
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

// The value of a member in Python.
template <class Value>
pybind11::object get_value(const ScenePointer&, const Value& value) {
  return pybind11::cast(value);
}
pybind11::object get_value(const ScenePointer& scene, const Color& value);
pybind11::object get_value(const ScenePointer& scene, const Vec3& value);
pybind11::object get_value(const ScenePointer& scene, const scene::AlphaMode& value);
pybind11::object get_value(const ScenePointer& scene, const scene::TextureSlot& value);

/// A value of Python for a member.
struct NewValue {
  const char* name;  ///< of the member
  pybind11::handle value;
  apps::RealRange range;  ///< of numbers
  const ScenePointer& scene;
};
// Each throws BadOption.
void set_value(float& member, const NewValue& given);
void set_value(bool& member, const NewValue& given);
void set_value(Color& member, const NewValue& given);
void set_value(Vec3& member, const NewValue& given);
void set_value(std::string& member, const NewValue& given);
void set_value(scene::AlphaMode& member, const NewValue& given);
void set_value(scene::TextureSlot& member, const NewValue& given);

template <class Object>
struct Field {
  using Get = std::function<pybind11::object(const ScenePointer&, const Object&)>;
  using Set = std::function<void(const ScenePointer&, Object&, pybind11::handle)>;
  const char* name;
  const char* help;
  Get get;
  Set set;  ///< throws BadOption

  /// A plain member. `range`: of numbers.
  template <class Value>
  Field(const char* its_name, Value Object::*member, const apps::RealRange& range, const char* its_help)
      : name(its_name),
        help(its_help),
        get([member](const ScenePointer& scene, const Object& object) {
          return get_value(scene, object.*member);
        }),
        set([its_name, member, range](const ScenePointer& scene, Object& object, pybind11::handle value) {
          set_value(object.*member, {its_name, value, range, scene});
        }) {}
  /// One that has another form in Python, which may depend on the scene.
  Field(const char* its_name, Get its_get, Set its_set, const char* its_help)
      : name(its_name), help(its_help), get(std::move(its_get)), set(std::move(its_set)) {}
  Field(const char* its_name, std::function<pybind11::object(const Object&)> get_of,
        std::function<void(Object&, pybind11::handle)> set_of, const char* its_help)
      : name(its_name),
        help(its_help),
        get([get_of](const ScenePointer&, const Object& object) { return get_of(object); }),
        set([set_of](const ScenePointer&, Object& object, pybind11::handle value) {
          set_of(object, value);
        }) {}
};

/// Throws BadOption, also for a name that is no member. `what`: the name of the class.
template <class Object>
void set_members(const std::vector<Field<Object>>& fields, const char* what, const ScenePointer& scene,
                 Object& object, const pybind11::dict& keywords) {
  std::vector<std::string> names;
  for (const Field<Object>& field : fields) names.emplace_back(field.name);
  for (const auto& [key, value] : keywords) {
    const std::string name = pybind11::str(key);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      throw BadOption({name, "", fmt::format("{} has no such member", what),
                       fmt::format("one of gatelight.{}", what), did_you_mean(name, names)});
    fields[static_cast<std::size_t>(found - names.begin())].set(scene, object, value);
  }
}

/// Adds a class of parts that have a name: their text, their index and the members of the table.
template <class PartOf, class Object>
pybind11::class_<PartOf> add_part_class(pybind11::module_& module, const char* name, const char* about,
                                        const std::vector<Field<Object>>& fields) {
  pybind11::class_<PartOf> type(module, name, about);
  type.def("__repr__", [name](const PartOf& part) {
    return fmt::format("<gatelight.{} {} '{}'>", name, part.index, part->name);
  });
  type.def_property_readonly("index", [](const PartOf& part) { return part.index; });
  for (const Field<Object>& field : fields) {
    type.def_property(
        field.name, [&field](const PartOf& part) { return field.get(part.scene, *part); },
        [&field](const PartOf& part, const pybind11::object& value) {
          field.set(part.scene, *part, value);
          part.scene->change();
        },
        field.help);
  }
  return type;
}

}  // namespace gatelight::python

#include <pybind11/stl.h>

#include <utility>
#include <variant>

#include "apps/python/fields.h"
#include "apps/python/module.h"
#include "scene/material_fields.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;
using scene::Material;

constexpr apps::RealRange kAtLeastZero{0.0, 3.4e38};

/// Which index of refraction is allowed depends on no range: 0 is one, and others begin at 1.
void set_ior(Material& material, py::handle value) {
  const float ior = number("ior", value, kAtLeastZero);
  if (ior != 0.0f && ior < 1.0f) throw BadOption({"ior", "", "it is below 1", "0 or a number of at least 1"});
  material.ior = ior;
}

/// The rows of scene::material_fields() that have a meaning for users.
const std::vector<Field<Material>>& fields() {
  static const std::vector<Field<Material>> fields = [] {
    std::vector<Field<Material>> made;
    for (const scene::MaterialField& row : scene::material_fields()) {
      const scene::FieldRange& range = row.range;
      const apps::RealRange allowed{
          .min = range.min, .max = range.max, .excludes_min = range.excludes_min, .infinity = range.infinity};
      if (row.member == scene::MaterialField::Member(&Material::ior)) {
        made.emplace_back(
            row.name, [](const Material& m) -> py::object { return py::float_(m.ior); }, set_ior,
            row.meaning);
      } else if (*row.meaning != '\0') {
        std::visit([&](auto member) { made.emplace_back(row.name, member, allowed, row.meaning); },
                   row.member);
      }
    }
    return made;
  }();
  return fields;
}

}  // namespace

MaterialPart make_material(const ScenePointer& scene, const py::kwargs& keywords) {
  Material material;
  set_members(fields(), "Material", scene, material, keywords);
  return MaterialPart::add(scene, std::move(material));
}

void add_materials(py::module_& module) {
  py::class_<TexturePart>(module, "Texture",
                          "A texture of a scene, for the members *_texture of its materials.")
      .def_property_readonly("index", [](const TexturePart& part) { return part.index; });
  add_part_class<MaterialPart>(
      module, "Material",
      "A material of a scene, in the terms of glTF 2.0. Changes apply from the next render on.", fields());
}

}  // namespace gatelight::python

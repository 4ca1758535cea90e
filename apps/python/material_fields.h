#pragma once
// The members of a material by their names in Python.

#include <pybind11/pybind11.h>

#include <string>
#include <variant>
#include <vector>

#include "apps/python/scene_data.h"
#include "apps/settings/parsing.h"

namespace gatelight::python {

struct MaterialField {
  using Member = std::variant<float scene::Material::*, Color scene::Material::*, bool scene::Material::*,
                              std::string scene::Material::*, scene::AlphaMode scene::Material::*,
                              scene::TextureSlot scene::Material::*>;
  const char* name;
  Member member;
  apps::RealRange range;
  const char* help;
};

const std::vector<MaterialField>& material_fields();

pybind11::object get_field(const MaterialField& field, const ScenePointer& scene,
                           const scene::Material& material);
/// Throws BadOption.
void set_field(const MaterialField& field, const ScenePointer& scene, scene::Material& material,
               pybind11::handle value);

}  // namespace gatelight::python

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "apps/python/conversions.h"
#include "apps/python/fields.h"
#include "apps/python/module.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;
using scene::Material;

constexpr apps::RealRange kUnit{0.0, 1.0};
constexpr apps::RealRange kAtLeastZero{0.0, 3.4e38};
constexpr apps::RealRange kDistance{.min = 0.0, .max = 3.4e38, .excludes_min = true, .infinity = true};

Material& get(const MaterialPart& part) {
  return part.scene->source.materials[part.index];
}

/// Which index of refraction is allowed depends on no range: 0 is one, and others begin at 1.
void set_ior(Material& material, py::handle value) {
  const float ior = number("ior", value, kAtLeastZero);
  if (ior != 0.0f && ior < 1.0f) throw BadOption({"ior", "", "it is below 1", "0 or a number of at least 1"});
  material.ior = ior;
}

const std::vector<Field<Material>>& material_fields() {
  using M = Material;
  static const std::vector<Field<Material>> fields = {
      {"name", &M::name, {}, "Name, for lights, light_groups and cryptomatte"},
      {"base_color", &M::base_color, kUnit, "Linear RGB"},
      {"base_alpha", &M::base_alpha, kUnit, "Opacity, for alpha_mode mask and blend"},
      {"base_color_texture", &M::base_color_texture, {}, "RGB sRGB, A linear; multiplies base_color"},
      {"metallic", &M::metallic, kUnit, "0 dielectric to 1 metal"},
      {"roughness", &M::roughness, kUnit, "Perceptual; alpha of GGX is its square"},
      {"metallic_roughness_texture", &M::metallic_roughness_texture, {}, "G roughness, B metallic"},
      {"normal_texture", &M::normal_texture, {}, "Tangent space, +Y up"},
      {"normal_scale", &M::normal_scale, apps::kAnyFloat, "Of x and y of the normal map"},
      {"emission", &M::emission, kAtLeastZero, "Radiance, linear RGB, W/(sr m2)"},
      {"emission_texture", &M::emission_texture, {}, "RGB sRGB; multiplies emission"},
      {"alpha_mode", &M::alpha_mode, {}, "opaque, mask or blend"},
      {"alpha_cutoff", &M::alpha_cutoff, kAtLeastZero, "Least opacity that is seen, for mask"},
      {"double_sided", &M::double_sided, {}, "Both sides reflect and emit"},
      {"unlit", &M::unlit, {}, "Shows base_color as radiance"},
      {"ior", [](const M& m) -> py::object { return py::float_(m.ior); }, set_ior,
       "Index of refraction, from 1"},
      {"specular", &M::specular, kUnit, "Strength of the dielectric reflection"},
      {"specular_texture", &M::specular_texture, {}, "A; multiplies specular"},
      {"specular_color", &M::specular_color, kAtLeastZero, "Of the dielectric reflection"},
      {"specular_color_texture", &M::specular_color_texture, {}, "RGB sRGB"},
      {"transmission", &M::transmission, kUnit, "Part of the light that passes, as through glass"},
      {"transmission_texture", &M::transmission_texture, {}, "R"},
      {"thickness", &M::thickness, kAtLeastZero, "0: an infinitely thin sheet; else a body with an inside"},
      {"attenuation_distance", &M::attenuation_distance, kDistance, "Metres, of attenuation_color"},
      {"attenuation_color", &M::attenuation_color, kUnit, "Colour of white light after that distance"},
      {"dispersion", &M::dispersion, kAtLeastZero, "20 over the Abbe number"},
      {"anisotropy", &M::anisotropy, kUnit, "Strength"},
      {"anisotropy_rotation", &M::anisotropy_rotation, apps::kAnyFloat, "Radians from the tangent"},
      {"anisotropy_texture", &M::anisotropy_texture, {}, "RG direction, B strength"},
      {"iridescence", &M::iridescence, kUnit, "Strength of a thin film"},
      {"iridescence_texture", &M::iridescence_texture, {}, "R"},
      {"film_ior", &M::film_ior, {.min = 1.0, .max = 100.0}, "Index of refraction of the film"},
      {"film_thickness_minimum", &M::film_thickness_minimum, kAtLeastZero,
       "Nanometres, where its texture is 0"},
      {"film_thickness_maximum", &M::film_thickness_maximum, kAtLeastZero, "Nanometres"},
      {"film_thickness_texture", &M::film_thickness_texture, {}, "G"},
      {"clearcoat", &M::clearcoat, kUnit, "Strength of a layer of varnish"},
      {"clearcoat_texture", &M::clearcoat_texture, {}, "R"},
      {"clearcoat_roughness", &M::clearcoat_roughness, kUnit, "Perceptual"},
      {"clearcoat_roughness_texture", &M::clearcoat_roughness_texture, {}, "G"},
      {"clearcoat_normal_texture", &M::clearcoat_normal_texture, {}, "Tangent space"},
      {"clearcoat_normal_scale", &M::clearcoat_normal_scale, apps::kAnyFloat, "Of its normal map"},
      {"diffuse_transmission", &M::diffuse_transmission, kUnit,
       "Part of the light that passes as through paper"},
      {"diffuse_transmission_texture", &M::diffuse_transmission_texture, {}, "A"},
      {"diffuse_transmission_color", &M::diffuse_transmission_color, kUnit, "Linear RGB"},
      {"diffuse_transmission_color_texture", &M::diffuse_transmission_color_texture, {}, "RGB sRGB"},
      {"sheen_color", &M::sheen_color, kUnit, "Of cloth, linear RGB"},
      {"sheen_color_texture", &M::sheen_color_texture, {}, "RGB sRGB"},
      {"sheen_roughness", &M::sheen_roughness, kUnit, "Perceptual"},
      {"sheen_roughness_texture", &M::sheen_roughness_texture, {}, "A"},
  };
  return fields;
}

}  // namespace

MaterialPart make_material(const ScenePointer& scene, const py::kwargs& keywords) {
  Material material;
  set_members(material_fields(), "Material", scene, material, keywords);
  scene->source.materials.push_back(std::move(material));
  scene->change();
  return {{scene, scene->source.materials.size() - 1}};
}

void add_materials(py::module_& module) {
  py::class_<TexturePart>(module, "Texture",
                          "A texture of a scene, for the members *_texture of its materials.")
      .def_property_readonly("index", [](const TexturePart& part) { return part.index; });
  py::class_<MaterialPart> material(
      module, "Material",
      "A material of a scene, in the terms of glTF 2.0. A new value counts from the next render.");
  material.def("__repr__", [](const MaterialPart& part) {
    return fmt::format("<gatelight.Material {} '{}'>", part.index, get(part).name);
  });
  add_fields(material, material_fields(), &scene::Scene::materials);
}

}  // namespace gatelight::python

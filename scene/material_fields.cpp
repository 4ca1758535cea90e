#include "scene/material_fields.h"

#include <algorithm>

namespace gatelight::scene {
namespace {

constexpr FieldRange kAny{};
constexpr FieldRange kUnit{.min = 0.0, .max = 1.0};
constexpr FieldRange kAtLeastZero{.min = 0.0};
constexpr FieldRange kDistance{.min = 0.0, .excludes_min = true, .infinity = true};
constexpr FieldRange kIndex{.min = 1.0, .or_zero = true};
constexpr FieldRange kFilmIndex{.min = 1.0, .max = 100.0};
constexpr FieldRange kAnisotropyOfScattering{.min = -0.99, .max = 0.99};
constexpr FieldRange kSrgb{.srgb = true};
constexpr FieldRange kLinear{};

constexpr const char* kCore = "";
constexpr const char* kSpecular = "KHR_materials_specular";
constexpr const char* kTransmission = "KHR_materials_transmission";
constexpr const char* kVolume = "KHR_materials_volume";
constexpr const char* kScatter = "KHR_materials_volume_scatter";
constexpr const char* kAnisotropy = "KHR_materials_anisotropy";
constexpr const char* kIridescence = "KHR_materials_iridescence";
constexpr const char* kClearcoat = "KHR_materials_clearcoat";
constexpr const char* kDiffuse = "KHR_materials_diffuse_transmission";
constexpr const char* kSheen = "KHR_materials_sheen";

#define FIELD(member) #member, &Material::member
constexpr MaterialField kFields[] = {
    {FIELD(name), kCore, "name", kAny, "Name, for lights, light_groups and cryptomatte"},
    {FIELD(base_color), kCore, "pbrMetallicRoughness/baseColorFactor", kUnit, "Linear RGB"},
    {FIELD(base_alpha), kCore, "pbrMetallicRoughness/baseColorFactor/3", kUnit,
     "Opacity, for alpha_mode mask and blend"},
    {FIELD(base_color_texture), kCore, "pbrMetallicRoughness/baseColorTexture", kSrgb,
     "RGB sRGB, A linear; multiplies base_color"},
    {FIELD(metallic), kCore, "pbrMetallicRoughness/metallicFactor", kUnit, "0 dielectric to 1 metal"},
    {FIELD(roughness), kCore, "pbrMetallicRoughness/roughnessFactor", kUnit,
     "Perceptual; alpha of GGX is its square"},
    {FIELD(metallic_roughness_texture), kCore, "pbrMetallicRoughness/metallicRoughnessTexture", kLinear,
     "G roughness, B metallic"},
    {FIELD(normal_texture), kCore, "normalTexture", kLinear, "Tangent space, +Y up"},
    {FIELD(normal_scale), kCore, "normalTexture/scale", kAny, "Of x and y of the normal map"},
    {FIELD(emission), kCore, "emissiveFactor", kAtLeastZero, "Radiance, linear RGB, W/(sr m2)"},
    {FIELD(emission_texture), kCore, "emissiveTexture", kSrgb, "RGB sRGB; multiplies emission"},
    {FIELD(alpha_mode), kCore, "alphaMode", kAny, "opaque, mask or blend"},
    {FIELD(alpha_cutoff), kCore, "alphaCutoff", kAtLeastZero, "Smallest visible opacity, for mask"},
    {FIELD(double_sided), kCore, "doubleSided", kAny, "Both sides reflect and emit"},
    {FIELD(unlit), "KHR_materials_unlit", "", kAny, "Shows base_color as radiance"},
    {FIELD(ior), "KHR_materials_ior", "ior", kIndex, "Index of refraction, from 1"},
    {FIELD(specular), kSpecular, "specularFactor", kUnit, "Strength of the dielectric reflection"},
    {FIELD(specular_texture), kSpecular, "specularTexture", kLinear, "A; multiplies specular"},
    // Values above 1 are allowed: the renderer limits the reflectance at normal incidence, not the factor.
    {FIELD(specular_color), kSpecular, "specularColorFactor", kAtLeastZero, "Of the dielectric reflection"},
    {FIELD(specular_color_texture), kSpecular, "specularColorTexture", kSrgb, "RGB sRGB"},
    {FIELD(glossiness_texture), kCore, "", kSrgb, ""},
    {FIELD(transmission), kTransmission, "transmissionFactor", kUnit,
     "Fraction of transmitted light, as in glass"},
    {FIELD(transmission_texture), kTransmission, "transmissionTexture", kLinear, "R"},
    // Only rasterisers need the value of the thickness; rays measure it. Its texture is not read.
    {FIELD(thickness), kVolume, "thicknessFactor", kAtLeastZero,
     "0: an infinitely thin sheet; else a solid body"},
    {FIELD(attenuation_distance), kVolume, "attenuationDistance", kDistance, "Metres, of attenuation_color"},
    {FIELD(attenuation_color), kVolume, "attenuationColor", kUnit,
     "Colour of white light after that distance"},
    {FIELD(multiscatter_color), kScatter, "multiscatterColorFactor", kUnit,
     "Reflectance of a half space of the interior, which scatters light; black: it only absorbs"},
    {FIELD(scatter_anisotropy), kScatter, "scatterAnisotropy", kAnisotropyOfScattering,
     "Mean cosine of scattering in the interior: positive is forward"},
    {FIELD(dispersion), "KHR_materials_dispersion", "dispersion", kAtLeastZero, "20 over the Abbe number"},
    {FIELD(anisotropy), kAnisotropy, "anisotropyStrength", kUnit, "Strength"},
    {FIELD(anisotropy_rotation), kAnisotropy, "anisotropyRotation", kAny, "Radians from the tangent"},
    {FIELD(anisotropy_texture), kAnisotropy, "anisotropyTexture", kLinear, "RG direction, B strength"},
    {FIELD(iridescence), kIridescence, "iridescenceFactor", kUnit, "Strength of a thin film"},
    {FIELD(iridescence_texture), kIridescence, "iridescenceTexture", kLinear, "R"},
    {FIELD(film_ior), kIridescence, "iridescenceIor", kFilmIndex, "Index of refraction of the film"},
    {FIELD(film_thickness_minimum), kIridescence, "iridescenceThicknessMinimum", kAtLeastZero,
     "Nanometres, where its texture is 0"},
    {FIELD(film_thickness_maximum), kIridescence, "iridescenceThicknessMaximum", kAtLeastZero, "Nanometres"},
    {FIELD(film_thickness_texture), kIridescence, "iridescenceThicknessTexture", kLinear, "G"},
    {FIELD(clearcoat), kClearcoat, "clearcoatFactor", kUnit, "Strength of a layer of varnish"},
    {FIELD(clearcoat_texture), kClearcoat, "clearcoatTexture", kLinear, "R"},
    {FIELD(clearcoat_roughness), kClearcoat, "clearcoatRoughnessFactor", kUnit, "Perceptual"},
    {FIELD(clearcoat_roughness_texture), kClearcoat, "clearcoatRoughnessTexture", kLinear, "G"},
    {FIELD(clearcoat_normal_texture), kClearcoat, "clearcoatNormalTexture", kLinear, "Tangent space"},
    {FIELD(clearcoat_normal_scale), kClearcoat, "clearcoatNormalTexture/scale", kAny, "Of its normal map"},
    {FIELD(diffuse_transmission), kDiffuse, "diffuseTransmissionFactor", kUnit,
     "Fraction of diffusely transmitted light, as in paper"},
    {FIELD(diffuse_transmission_texture), kDiffuse, "diffuseTransmissionTexture", kLinear, "A"},
    {FIELD(diffuse_transmission_color), kDiffuse, "diffuseTransmissionColorFactor", kUnit, "Linear RGB"},
    {FIELD(diffuse_transmission_color_texture), kDiffuse, "diffuseTransmissionColorTexture", kSrgb,
     "RGB sRGB"},
    {FIELD(sheen_color), kSheen, "sheenColorFactor", kUnit, "Of cloth, linear RGB"},
    {FIELD(sheen_color_texture), kSheen, "sheenColorTexture", kSrgb, "RGB sRGB"},
    {FIELD(sheen_roughness), kSheen, "sheenRoughnessFactor", kUnit, "Perceptual"},
    {FIELD(sheen_roughness_texture), kSheen, "sheenRoughnessTexture", kLinear, "A"},
};
#undef FIELD

/// Reflection and transmission of glTF's base are no rows. Anisotropy only shapes the reflection.
constexpr MaterialLobe kLobes[] = {
    {"diffuse_transmission", kDiffuse},
    {"iridescence", kIridescence},
    {"anisotropy", kAnisotropy, false},
    {"clearcoat", kClearcoat},
    {"sheen", kSheen},
};

}  // namespace

std::span<const MaterialField> material_fields() {
  return kFields;
}

bool is_used(const Material& material, std::string_view extension) {
  const auto* const factor =
      std::find_if(std::begin(kFields), std::end(kFields),
                   [&](const MaterialField& field) { return field.extension == extension; });
  if (factor == std::end(kFields)) return false;
  if (const auto* const number = std::get_if<float Material::*>(&factor->member))
    return material.*(*number) > 0.0f;
  const auto* const color = std::get_if<Color Material::*>(&factor->member);
  return color && (material.*(*color) > 0.0f).any();
}

std::span<const MaterialLobe> material_lobes() {
  return kLobes;
}

}  // namespace gatelight::scene

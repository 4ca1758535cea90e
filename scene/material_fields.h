#pragma once
// The members of a material as a table: the names that files and programs have for them, and their values.

#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "scene/scene.h"

namespace gatelight::scene {

/// The values of a member.
struct FieldRange {
  double min = -3.4e38;  ///< of a number, and of each channel of a colour
  double max = 3.4e38;
  bool excludes_min = false;
  bool or_zero = false;   ///< 0 is allowed below `min`
  bool infinity = false;  ///< is allowed
  bool srgb = false;      ///< of a texture: its RGB are sRGB values, all else is linear
};

/// A member of Material. All are in the table but `culled`, which LoadOptions::back_faces decides.
struct MaterialField {
  using Member = std::variant<float Material::*, Color Material::*, bool Material::*, std::string Material::*,
                              AlphaMode Material::*, TextureSlot Material::*>;
  const char* name;  ///< of the member
  Member member;
  const char* extension;  ///< of glTF; empty: glTF 2.0 itself has it
  const char* property;   ///< its JSON pointer in the extension, else in the material; empty: it has none
  FieldRange range;
  const char* meaning;  ///< for users, with its unit; empty: only files have it
};

/// In the order of Material's members. The first one of an extension is its factor: where it is zero, the
/// others have no effect.
std::span<const MaterialField> material_fields();

/// Whether the factor of an extension is above zero.
bool is_used(const Material& material, std::string_view extension);

/// An extension that adds a lobe to the material, or shapes one.
struct MaterialLobe {
  std::string_view name;  ///< of the extension, without "KHR_materials_"
  const char* extension;
  bool view_dependent = true;  ///< a surface that has no other lobes looks different from other directions
};
std::span<const MaterialLobe> material_lobes();

/// Calls visit(slot, whether its RGB are sRGB values) for every texture slot of a material, in their order.
template <typename M, typename Visit>
void for_each_slot(M& material, const Visit& visit) {
  for (const MaterialField& field : material_fields()) {
    if (const auto* const slot = std::get_if<TextureSlot Material::*>(&field.member))
      visit(material.*(*slot), field.range.srgb);
  }
}

/// Whether the slot, one of the material's, holds a normal map.
inline bool is_normal_map(const Material& m, const TextureSlot& slot) {
  return &slot == &m.normal_texture || &slot == &m.clearcoat_normal_texture;
}

}  // namespace gatelight::scene

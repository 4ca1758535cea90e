#include "scene/gltf/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "scene/gltf/extensions.h"

namespace gatelight::scene::gltf {
namespace {

using tinygltf::Value;

class Converter {
 public:
  Converter(const Document& document, int index, Warnings& warnings)
      : document_(document), where_(fmt::format("materials[{}]", index)), warnings_(warnings) {}

  Material convert(const tinygltf::Material& source) {
    Material m;
    m.name = source.name;
    const auto& pbr = source.pbrMetallicRoughness;
    if (pbr.baseColorFactor.size() == 4) {
      const auto& f = pbr.baseColorFactor;
      m.base_color = {unit(f[0], "baseColorFactor"), unit(f[1], "baseColorFactor"),
                      unit(f[2], "baseColorFactor")};
      m.base_alpha = unit(f[3], "baseColorFactor");
    }
    m.base_color_texture = slot(pbr.baseColorTexture, "baseColorTexture");
    m.metallic = unit(pbr.metallicFactor, "metallicFactor");
    m.roughness = unit(pbr.roughnessFactor, "roughnessFactor");
    m.metallic_roughness_texture = slot(pbr.metallicRoughnessTexture, "metallicRoughnessTexture");
    m.normal_texture = slot(source.normalTexture, "normalTexture");
    m.normal_scale = static_cast<float>(source.normalTexture.scale);
    m.emission_texture = slot(source.emissiveTexture, "emissiveTexture");
    if (source.emissiveFactor.size() == 3) {
      for (int c = 0; c < 3; ++c)
        m.emission[c] = unit(source.emissiveFactor[static_cast<std::size_t>(c)], "emissiveFactor");
    }
    if (source.alphaMode == "MASK") m.alpha_mode = AlphaMode::mask;
    if (source.alphaMode == "BLEND") m.alpha_mode = AlphaMode::blend;
    m.alpha_cutoff = static_cast<float>(source.alphaCutoff);
    m.double_sided = source.doubleSided;
    read_extensions(source.extensions, m);
    drop_unread_textures(m);
    return m;
  }

 private:
  void read_extensions(const tinygltf::ExtensionMap& extensions, Material& m) {
    m.unlit = find_extension(extensions, "KHR_materials_unlit") != nullptr;
    if (const Value* e = find_extension(extensions, "KHR_materials_emissive_strength")) {
      m.emission *= static_cast<float>(number_or(*e, "emissiveStrength", 1.0));
      if (!m.emission.allFinite())
        document_.fail(where_, "emissiveStrength too large, expected finite emission");
    }
    if (const Value* e = find_extension(extensions, "KHR_materials_ior")) {
      const float ior = static_cast<float>(number_or(*e, "ior", 1.5));
      m.ior = ior == 0.0f ? 0.0f : std::max(ior, 1.0f);
      if (m.ior != ior) warnings_.add(where_ + ".ior: below 1, taken as 1");
    }
    if (const Value* e = find_extension(extensions, "KHR_materials_specular")) {
      m.specular = unit(number_or(*e, "specularFactor", 1.0), "specularFactor");
      m.specular_texture = slot(*e, "specularTexture");
      // Values above 1 are allowed: the renderer limits the reflectance at normal incidence, not the factor.
      m.specular_color = color(*e, "specularColorFactor", 1.0f).max(0.0f);
      m.specular_color_texture = slot(*e, "specularColorTexture");
    }
    if (const Value* e = find_extension(extensions, "KHR_materials_transmission")) {
      m.transmission = unit(number_or(*e, "transmissionFactor", 0.0), "transmissionFactor");
      m.transmission_texture = slot(*e, "transmissionTexture");
    }
    if (const Value* e = find_extension(extensions, "KHR_materials_volume")) {
      // Only rasterisers need the value of the thickness; rays measure it. Its texture is not read.
      m.thickness = static_cast<float>(number_or(*e, "thicknessFactor", 0.0));
      m.attenuation_distance = static_cast<float>(number_or(*e, "attenuationDistance", kInfinity));
      m.attenuation_color = unit_color(*e, "attenuationColor", 1.0f);
    }
    if (const Value* e = find_extension(extensions, "KHR_materials_clearcoat")) {
      m.clearcoat = unit(number_or(*e, "clearcoatFactor", 0.0), "clearcoatFactor");
      m.clearcoat_texture = slot(*e, "clearcoatTexture");
      m.clearcoat_roughness =
          unit(number_or(*e, "clearcoatRoughnessFactor", 0.0), "clearcoatRoughnessFactor");
      m.clearcoat_roughness_texture = slot(*e, "clearcoatRoughnessTexture");
      m.clearcoat_normal_texture = slot(*e, "clearcoatNormalTexture");
      if (e->Has("clearcoatNormalTexture")) {
        m.clearcoat_normal_scale =
            static_cast<float>(number_or(e->Get("clearcoatNormalTexture"), "scale", 1.0));
      }
    }
    if (const Value* e = find_extension(extensions, "KHR_materials_sheen")) {
      m.sheen_color = unit_color(*e, "sheenColorFactor", 0.0f);
      m.sheen_color_texture = slot(*e, "sheenColorTexture");
      m.sheen_roughness = unit(number_or(*e, "sheenRoughnessFactor", 0.0), "sheenRoughnessFactor");
      m.sheen_roughness_texture = slot(*e, "sheenRoughnessTexture");
    }
  }

  /// A texture whose factor is zero has no effect: it is not decoded and need not exist.
  static void drop_unread_textures(Material& m) {
    const auto keep = [](bool condition, std::initializer_list<TextureSlot*> slots) {
      for (TextureSlot* slot : slots) {
        if (!condition) *slot = {};
      }
    };
    keep(!m.unlit, {&m.metallic_roughness_texture, &m.normal_texture, &m.emission_texture});
    keep(m.emits(), {&m.emission_texture});
    keep(!m.unlit && m.specular > 0.0f, {&m.specular_texture, &m.specular_color_texture});
    keep(!m.unlit && m.transmits(), {&m.transmission_texture});
    keep(!m.unlit && m.clearcoat > 0.0f,
         {&m.clearcoat_texture, &m.clearcoat_roughness_texture, &m.clearcoat_normal_texture});
    keep(!m.unlit && (m.sheen_color > 0.0f).any(), {&m.sheen_color_texture, &m.sheen_roughness_texture});
  }

  float unit(double value, std::string_view name) {
    const double clamped = std::clamp(value, 0.0, 1.0);
    if (clamped != value) {
      warnings_.add(fmt::format("{}.{}: {:g} is outside 0 to 1 and clamped", where_, name, value));
    }
    return static_cast<float>(clamped);
  }

  Color color(const Value& object, const std::string& name, float fallback) const {
    if (!object.Has(name)) return Color::Constant(fallback);
    const Value& v = object.Get(name);
    return {static_cast<float>(v.Get(0).GetNumberAsDouble()),
            static_cast<float>(v.Get(1).GetNumberAsDouble()),
            static_cast<float>(v.Get(2).GetNumberAsDouble())};
  }

  Color unit_color(const Value& object, const std::string& name, float fallback) {
    const Color c = color(object, name, fallback);
    return {unit(c.x(), name), unit(c.y(), name), unit(c.z(), name)};
  }

  template <typename Info>
  TextureSlot slot(const Info& info, std::string_view name) {
    const Value* transform = find_extension(info.extensions, "KHR_texture_transform");
    return slot(info.index, info.texCoord, transform, name);
  }

  TextureSlot slot(const Value& extension, const std::string& name) {
    if (!extension.Has(name)) return {};
    const Value& info = extension.Get(name);
    const Value* transform = nullptr;
    if (info.Has("extensions") && info.Get("extensions").Has("KHR_texture_transform")) {
      transform = &info.Get("extensions").Get("KHR_texture_transform");
    }
    return slot(integer_or(info, "index", -1), integer_or(info, "texCoord", 0), transform, name);
  }

  TextureSlot slot(int index, int texcoord, const Value* transform, std::string_view name) {
    TextureSlot result;
    if (index < 0) return result;
    if (transform) {
      texcoord = integer_or(*transform, "texCoord", texcoord);
      result.transform = texture_transform(*transform);
    }
    if (texcoord > 1) {
      warnings_.add(
          fmt::format("{}.{}: texCoord {} is not supported, the texture is ignored", where_, name, texcoord));
      return result;
    }
    if (document_.model().textures[static_cast<std::size_t>(index)].source < 0) {
      warnings_.add(fmt::format("textures[{}]: has no image that can be read, it is ignored", index));
      return result;
    }
    result.texture = index;
    result.texcoord = texcoord;
    return result;
  }

  /// Translation * rotation * scale. The rotation is counter-clockwise as seen in the picture, where v points
  /// down from the upper left corner.
  static Eigen::Matrix<float, 2, 3> texture_transform(const Value& t) {
    const auto pair = [&](const std::string& name, double fallback) {
      if (!t.Has(name)) return Eigen::Vector2d(fallback, fallback);
      return Eigen::Vector2d(t.Get(name).Get(0).GetNumberAsDouble(), t.Get(name).Get(1).GetNumberAsDouble());
    };
    const Eigen::Vector2d offset = pair("offset", 0.0);
    const Eigen::Vector2d scale = pair("scale", 1.0);
    const double angle = number_or(t, "rotation", 0.0);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    Eigen::Matrix<double, 2, 3> m;
    m << c * scale.x(), s * scale.y(), offset.x(),  //
        -s * scale.x(), c * scale.y(), offset.y();
    return m.cast<float>();
  }

  const Document& document_;
  std::string where_;
  Warnings& warnings_;
};

Wrap convert_wrap(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp_to_edge;
  if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::mirrored_repeat;
  return Wrap::repeat;
}

}  // namespace

Material convert_material(const Document& document, int index, Warnings& warnings) {
  if (index < 0) return {};
  const tinygltf::Material& source = document.model().materials[static_cast<std::size_t>(index)];
  return Converter(document, index, warnings).convert(source);
}

Texture convert_texture(const Document& document, int index) {
  const tinygltf::Texture& source = document.model().textures[static_cast<std::size_t>(index)];
  Texture texture;
  texture.image = source.source;
  if (source.sampler >= 0) {
    const tinygltf::Sampler& sampler = document.model().samplers[static_cast<std::size_t>(source.sampler)];
    texture.wrap_s = convert_wrap(sampler.wrapS);
    texture.wrap_t = convert_wrap(sampler.wrapT);
    texture.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  }
  return texture;
}

}  // namespace gatelight::scene::gltf

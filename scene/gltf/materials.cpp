#include "scene/gltf/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>

#include "scene/gltf/model.h"
#include "scene/material_fields.h"

namespace gatelight::scene::gltf {
namespace {

using tinygltf::Value;

/// The image of a texture: the first of these that it has; or -1. Formats that cannot be read come last:
/// their image is used only so that the message can name its format.
int image_of(const tinygltf::Texture& texture) {
  const auto of = [&](const char* extension) {
    const Value* const found = find_extension(texture.extensions, extension);
    return found ? integer_or(*found, "source", -1) : -1;
  };
  for (const int image :
       {of("EXT_texture_webp"), texture.source, of("KHR_texture_basisu"), of("MSFT_texture_dds")}) {
    if (image >= 0) return image;
  }
  return -1;
}

class Converter {
 public:
  Converter(const Document& document, int index, Warnings& warnings)
      : document_(document), where_(fmt::format("materials[{}]", index)), warnings_(warnings) {}

  Material convert(const tinygltf::Material& source) {
    Material m;
    m.name = source.name;
    if (const Value* old = find_extension(source.extensions, "KHR_materials_pbrSpecularGlossiness")) {
      read_specular_glossiness(*old, m);
    } else {
      const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
      read_base(pbr.baseColorFactor, "baseColorFactor", m);
      m.base_color_texture = slot(pbr.baseColorTexture, "baseColorTexture");
      m.metallic = unit(pbr.metallicFactor, "metallicFactor");
      m.roughness = unit(pbr.roughnessFactor, "roughnessFactor");
      m.metallic_roughness_texture = slot(pbr.metallicRoughnessTexture, "metallicRoughnessTexture");
    }
    m.normal_texture = slot(source.normalTexture, "normalTexture");
    m.normal_scale = static_cast<float>(source.normalTexture.scale);
    m.emission_texture = slot(source.emissiveTexture, "emissiveTexture");
    m.emission = unit(Eigen::Vector3d(source.emissiveFactor.data()), "emissiveFactor");
    if (source.alphaMode == "MASK") m.alpha_mode = AlphaMode::mask;
    if (source.alphaMode == "BLEND") m.alpha_mode = AlphaMode::blend;
    m.alpha_cutoff = static_cast<float>(source.alphaCutoff);
    m.double_sided = source.doubleSided;
    read_extensions(source.extensions, m);
    read_scattering(source.extensions, m);
    drop_unread_textures(m);
    return m;
  }

 private:
  void read_base(const std::vector<double>& factor, const char* name, Material& m) {
    const auto base = vector_or<Eigen::Vector4d>(factor, Eigen::Vector4d::Ones());
    m.base_color = unit(base.head<3>(), name);
    m.base_alpha = unit(base[3], name);
  }

  /// The older material model: a dielectric whose reflectance at normal incidence is a colour.
  /// KHR_materials_ior keeps the index 0 for this: its Fresnel reflectance is 1, which the colour scales.
  void read_specular_glossiness(const Value& old, Material& m) {
    read_base(numbers_of(old, "diffuseFactor"), "diffuseFactor", m);
    m.base_color_texture = slot(old, "diffuseTexture");
    m.metallic = 0.0f;
    m.ior = 0.0f;
    m.specular_color =
        unit(vector_or<Eigen::Vector3d>(old, "specularFactor", Eigen::Vector3d::Ones()), "specularFactor");
    m.roughness = 1.0f - unit(number_or(old, "glossinessFactor", 1.0), "glossinessFactor");
    m.specular_color_texture = m.glossiness_texture = slot(old, "specularGlossinessTexture");
  }

  void read_extensions(const tinygltf::ExtensionMap& extensions, Material& m) {
    static const Material kDefaults;
    for (const MaterialField& field : material_fields()) {
      const Value* const extension = find_extension(extensions, field.extension);
      if (!extension) continue;
      const auto read_member = [&](auto member) { m.*member = read(*extension, field, kDefaults.*member); };
      std::visit(read_member, field.member);
    }
    if (const Value* e = find_extension(extensions, "KHR_materials_emissive_strength")) {
      m.emission *= float_or(*e, "emissiveStrength", 1.0f);
      if (!m.emission.allFinite())
        document_.fail(where_, "emissiveStrength too large, expected finite emission");
    }
  }

  /// Both drafts: KHR_materials_volume_scatter, whose colour had another name at first, and
  /// KHR_materials_scatter, which replaces it.
  void read_scattering(const tinygltf::ExtensionMap& extensions, Material& m) {
    if (const Value* e = find_extension(extensions, "KHR_materials_volume_scatter")) {
      if (!find_member(*e, "multiscatterColorFactor"))
        m.multiscatter_color = color(*e, "multiscatterColor", Eigen::Vector3d::Zero());
    }
    const Value* const e = find_extension(extensions, "KHR_materials_scatter");
    if (e) {
      const float strength = unit(number_or(*e, "scatterStrengthFactor", 0.0), "scatterStrengthFactor");
      m.multiscatter_color = color(*e, "multiscatterColorFactor", Eigen::Vector3d::Ones());
      m.scatter_anisotropy = float_or(*e, "scatterAnisotropy", 0.0f);
      for (const char* const texture : {"scatterStrengthTexture", "multiscatterColorTexture"}) {
        if (find_member(*e, texture))
          warnings_.add(
              fmt::format("{}.{}: the texture is ignored, only the factor is used", where_, texture));
      }
      if (m.has_volume()) {
        m.multiscatter_color *= strength;
      } else {
        make_thin_scatterer(strength, m);
      }
    }
    constexpr float kMax = 0.99f;
    const float anisotropy = std::clamp(m.scatter_anisotropy, -kMax, kMax);
    if (anisotropy != m.scatter_anisotropy)
      warnings_.add(fmt::format("{}.scatterAnisotropy: {:g} is taken as {:g}", where_,
                                static_cast<double>(m.scatter_anisotropy), static_cast<double>(anisotropy)));
    m.scatter_anisotropy = anisotropy;
  }

  /// A thin sheet scatters the share `strength` of what it transmits, forward as diffuse transmission and
  /// backward as diffuse reflection. Both have the colour of scattering; a clear share keeps the colour of
  /// the sheet only where nothing scatters, because the material has one colour for both.
  static void make_thin_scatterer(float strength, Material& m) {
    const float scattered = m.transmission * strength, opaque = 1.0f - m.transmission;
    m.transmission -= scattered;
    const float diffuse = opaque + scattered;
    if (!(scattered > 0.0f)) return;
    const float forward = scattered * 0.5f * (1.0f + m.scatter_anisotropy), backward = scattered - forward;
    m.diffuse_transmission = forward / diffuse;
    m.diffuse_transmission_color = m.multiscatter_color;
    const float reflected = opaque + backward;
    if (reflected > 0.0f)
      m.base_color = (opaque * m.base_color + backward * m.multiscatter_color) / reflected;
    m.multiscatter_color.setZero();
  }

  Color color(const Value& object, const char* name, const Eigen::Vector3d& fallback) {
    return unit(vector_or<Eigen::Vector3d>(object, name, fallback), name);
  }

  float read(const Value& extension, const MaterialField& field, float fallback) {
    const FieldRange& range = field.range;
    const double number = number_at(extension, field.property, static_cast<double>(fallback));
    if (range.max == 1.0) return unit(number, field.property);
    const auto value = static_cast<float>(number);
    const auto least = static_cast<float>(range.min);
    if (!(least > 0.0f) || value >= least || (range.or_zero && value == 0.0f)) return value;
    warnings_.add(fmt::format("{}.{}: below {:g}, taken as {:g}", where_, field.property, least, least));
    return least;
  }

  Color read(const Value& extension, const MaterialField& field, const Color& fallback) {
    const auto color = vector_or<Color>(extension, field.property, fallback);
    if (field.range.max == 1.0) return unit(color.matrix().cast<double>(), field.property);
    return color.max(0.0f);
  }

  TextureSlot read(const Value& extension, const MaterialField& field, const TextureSlot&) {
    return slot(extension, field.property);
  }

  /// Of an extension without members.
  static bool read(const Value&, const MaterialField&, bool) { return true; }

  /// No extension has names and modes.
  template <typename T>
  static T read(const Value&, const MaterialField&, const T& fallback) {
    return fallback;
  }

  /// A texture whose factor is zero has no effect: it is not decoded and need not exist.
  static void drop_unread_textures(Material& m) {
    for (const MaterialField& field : material_fields()) {
      const auto* const member = std::get_if<TextureSlot Material::*>(&field.member);
      if (!member || *member == &Material::base_color_texture) continue;
      const bool of_extension = *field.extension != '\0';
      if (m.unlit || (of_extension && !is_used(m, field.extension))) m.*(*member) = {};
    }
    if (!m.emits()) m.emission_texture = {};
  }

  float unit(double value, std::string_view name) {
    const double clamped = std::clamp(value, 0.0, 1.0);
    constexpr double kRounding = 1e-6;  // of single precision
    if (std::abs(clamped - value) > kRounding) {
      warnings_.add(fmt::format("{}.{}: {:g} is outside 0 to 1 and clamped", where_, name, value));
    }
    return static_cast<float>(clamped);
  }

  Color unit(const Eigen::Vector3d& values, std::string_view name) {
    return {unit(values[0], name), unit(values[1], name), unit(values[2], name)};
  }

  /// `path` is the name of a member, after those of the objects around it.
  static double number_at(const Value& object, std::string_view path, double fallback) {
    const std::size_t slash = path.find('/');
    const std::string name(path.substr(0, slash));
    if (slash == std::string_view::npos) return number_or(object, name.c_str(), fallback);
    const Value* const inner = find_member(object, name.c_str());
    return inner ? number_at(*inner, path.substr(slash + 1), fallback) : fallback;
  }

  TextureSlot slot(const Value& object, const char* name) {
    const Value* info = find_member(object, name);
    if (!info) return {};
    const Value* extensions = find_member(*info, "extensions");
    return slot(integer_or(*info, "index", -1), integer_or(*info, "texCoord", 0),
                extensions ? find_member(*extensions, "KHR_texture_transform") : nullptr, name);
  }

  /// Info is one of tinygltf's three types of texture references.
  template <typename Info>
  TextureSlot slot(const Info& info, const char* name) {
    if (info.index < 0) return {};
    return slot(info.index, info.texCoord, find_extension(info.extensions, "KHR_texture_transform"), name);
  }

  TextureSlot slot(int index, int texcoord, const Value* transform, const char* name) {
    TextureSlot result;
    if (transform) {
      texcoord = integer_or(*transform, "texCoord", texcoord);
      result.transform = texture_transform(*transform);
    }
    if (texcoord > 1) {
      warnings_.add(
          fmt::format("{}.{}: texCoord {} is not supported; the texture is ignored", where_, name, texcoord));
      return result;
    }
    if (image_of(element(document_.model().textures, index)) < 0) {
      warnings_.add(fmt::format("textures[{}]: no readable image; the texture is ignored", index));
      return result;
    }
    result.texture = index;
    result.texcoord = texcoord;
    return result;
  }

  /// Translation * rotation * scale. The rotation is counter-clockwise as seen in the picture, where v points
  /// down from the upper left corner.
  static Eigen::Matrix<float, 2, 3> texture_transform(const Value& t) {
    const auto offset = vector_or<Eigen::Vector2d>(t, "offset", Eigen::Vector2d::Zero());
    const auto scale = vector_or<Eigen::Vector2d>(t, "scale", Eigen::Vector2d::Ones());
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
  return Converter(document, index, warnings).convert(element(document.model().materials, index));
}

Texture convert_texture(const Document& document, int index) {
  const tinygltf::Texture& source = element(document.model().textures, index);
  Texture texture;
  texture.image = image_of(source);
  if (source.sampler >= 0) {
    const tinygltf::Sampler& sampler = element(document.model().samplers, source.sampler);
    texture.wrap_s = convert_wrap(sampler.wrapS);
    texture.wrap_t = convert_wrap(sampler.wrapT);
    texture.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  }
  return texture;
}

}  // namespace gatelight::scene::gltf

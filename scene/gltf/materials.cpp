#include "scene/gltf/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "scene/gltf/extensions.h"

namespace gatelight::scene::gltf {
namespace {

// OpenGL's numbers, which glTF uses.
constexpr int kNearest = 9728;
constexpr int kRepeat = 10497;
constexpr int kClampToEdge = 33071;
constexpr int kMirroredRepeat = 33648;

/// The image of a texture: the first of these that it has; or -1. Formats that cannot be read come last:
/// their image is used only so that the message can name its format.
int image_of(const json& texture) {
  const auto of = [&](const char* extension) {
    const json* const found = find_extension(texture, extension);
    return found ? found->value("source", -1) : -1;
  };
  for (const int image : {of("EXT_texture_webp"), texture.value("source", -1), of("KHR_texture_basisu"),
                          of("MSFT_texture_dds")}) {
    if (image >= 0) return image;
  }
  return -1;
}

class Converter {
 public:
  Converter(const Document& document, int index, Warnings& warnings)
      : document_(document), where_(fmt::format("materials[{}]", index)), warnings_(warnings) {}

  Material convert(const json& source) {
    Material m;
    m.name = source.value("name", "");
    if (const json* old = find_extension(source, "KHR_materials_pbrSpecularGlossiness")) {
      read_specular_glossiness(*old, m);
    } else {
      const json pbr = source.value("pbrMetallicRoughness", json::object());
      read_base(pbr, "baseColorFactor", "baseColorTexture", m);
      m.metallic = unit(pbr, "metallicFactor", 1.0);
      m.roughness = unit(pbr, "roughnessFactor", 1.0);
      m.metallic_roughness_texture = slot(pbr, "metallicRoughnessTexture");
    }
    m.normal_texture = slot(source, "normalTexture");
    m.normal_scale = normal_scale(source, "normalTexture");
    m.emission_texture = slot(source, "emissiveTexture");
    m.emission =
        unit(vector_or<Eigen::Vector3d>(source, "emissiveFactor", Eigen::Vector3d::Zero()), "emissiveFactor");
    const std::string alpha_mode = source.value("alphaMode", "OPAQUE");
    if (alpha_mode == "MASK") m.alpha_mode = AlphaMode::mask;
    if (alpha_mode == "BLEND") m.alpha_mode = AlphaMode::blend;
    m.alpha_cutoff = source.value("alphaCutoff", 0.5f);
    m.double_sided = source.value("doubleSided", false);
    read_extensions(source, m);
    drop_unread_textures(m);
    return m;
  }

 private:
  void read_base(const json& object, const char* factor, const char* texture, Material& m) {
    const auto base = vector_or<Eigen::Vector4d>(object, factor, Eigen::Vector4d::Ones());
    m.base_color = unit(base.head<3>(), factor);
    m.base_alpha = unit(base[3], factor);
    m.base_color_texture = slot(object, texture);
  }

  /// The older material model: a dielectric whose reflectance at normal incidence is a colour.
  /// KHR_materials_ior keeps the index 0 for this: its Fresnel reflectance is 1, which the colour scales.
  void read_specular_glossiness(const json& old, Material& m) {
    read_base(old, "diffuseFactor", "diffuseTexture", m);
    m.metallic = 0.0f;
    m.ior = 0.0f;
    m.specular_color =
        unit(vector_or<Eigen::Vector3d>(old, "specularFactor", Eigen::Vector3d::Ones()), "specularFactor");
    m.roughness = 1.0f - unit(old, "glossinessFactor", 1.0);
    m.specular_color_texture = m.glossiness_texture = slot(old, "specularGlossinessTexture");
  }

  void read_extensions(const json& material, Material& m) {
    m.unlit = find_extension(material, "KHR_materials_unlit") != nullptr;
    if (const json* e = find_extension(material, "KHR_materials_emissive_strength")) {
      m.emission *= e->value("emissiveStrength", 1.0f);
      if (!m.emission.allFinite())
        document_.fail(where_, "emissiveStrength too large, expected finite emission");
    }
    if (const json* e = find_extension(material, "KHR_materials_ior")) {
      const float ior = e->value("ior", 1.5f);
      m.ior = ior == 0.0f ? 0.0f : std::max(ior, 1.0f);
      if (m.ior != ior) warnings_.add(where_ + ".ior: below 1, taken as 1");
    }
    if (const json* e = find_extension(material, "KHR_materials_specular")) {
      m.specular = unit(*e, "specularFactor", 1.0);
      m.specular_texture = slot(*e, "specularTexture");
      // Values above 1 are allowed: the renderer limits the reflectance at normal incidence, not the factor.
      m.specular_color = vector_or<Color>(*e, "specularColorFactor", Color::Ones()).max(0.0f);
      m.specular_color_texture = slot(*e, "specularColorTexture");
    }
    if (const json* e = find_extension(material, "KHR_materials_transmission")) {
      m.transmission = unit(*e, "transmissionFactor", 0.0);
      m.transmission_texture = slot(*e, "transmissionTexture");
    }
    if (const json* e = find_extension(material, "KHR_materials_diffuse_transmission")) {
      m.diffuse_transmission = unit(*e, "diffuseTransmissionFactor", 0.0);
      m.diffuse_transmission_texture = slot(*e, "diffuseTransmissionTexture");
      m.diffuse_transmission_color = unit_color(*e, "diffuseTransmissionColorFactor", 1.0f);
      m.diffuse_transmission_color_texture = slot(*e, "diffuseTransmissionColorTexture");
    }
    if (const json* e = find_extension(material, "KHR_materials_volume")) {
      // Only rasterisers need the value of the thickness; rays measure it. Its texture is not read.
      m.thickness = e->value("thicknessFactor", 0.0f);
      m.attenuation_distance = e->value("attenuationDistance", kInfinity);
      m.attenuation_color = unit_color(*e, "attenuationColor", 1.0f);
    }
    if (const json* e = find_extension(material, "KHR_materials_dispersion"))
      m.dispersion = e->value("dispersion", 0.0f);
    if (const json* e = find_extension(material, "KHR_materials_iridescence")) {
      m.iridescence = unit(*e, "iridescenceFactor", 0.0);
      m.iridescence_texture = slot(*e, "iridescenceTexture");
      const float ior = e->value("iridescenceIor", 1.3f);
      m.film_ior = std::max(ior, 1.0f);
      if (m.film_ior != ior) warnings_.add(where_ + ".iridescenceIor: below 1, taken as 1");
      m.film_thickness_minimum = e->value("iridescenceThicknessMinimum", 100.0f);
      m.film_thickness_maximum = e->value("iridescenceThicknessMaximum", 400.0f);
      m.film_thickness_texture = slot(*e, "iridescenceThicknessTexture");
    }
    if (const json* e = find_extension(material, "KHR_materials_anisotropy")) {
      m.anisotropy = unit(*e, "anisotropyStrength", 0.0);
      m.anisotropy_rotation = e->value("anisotropyRotation", 0.0f);
      m.anisotropy_texture = slot(*e, "anisotropyTexture");
    }
    if (const json* e = find_extension(material, "KHR_materials_clearcoat")) {
      m.clearcoat = unit(*e, "clearcoatFactor", 0.0);
      m.clearcoat_texture = slot(*e, "clearcoatTexture");
      m.clearcoat_roughness = unit(*e, "clearcoatRoughnessFactor", 0.0);
      m.clearcoat_roughness_texture = slot(*e, "clearcoatRoughnessTexture");
      m.clearcoat_normal_texture = slot(*e, "clearcoatNormalTexture");
      m.clearcoat_normal_scale = normal_scale(*e, "clearcoatNormalTexture");
    }
    if (const json* e = find_extension(material, "KHR_materials_sheen")) {
      m.sheen_color = unit_color(*e, "sheenColorFactor", 0.0f);
      m.sheen_color_texture = slot(*e, "sheenColorTexture");
      m.sheen_roughness = unit(*e, "sheenRoughnessFactor", 0.0);
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
    keep(!m.unlit,
         {&m.metallic_roughness_texture, &m.glossiness_texture, &m.normal_texture, &m.emission_texture});
    keep(m.emits(), {&m.emission_texture});
    keep(!m.unlit && m.specular > 0.0f, {&m.specular_texture, &m.specular_color_texture});
    keep(!m.unlit && m.iridescence > 0.0f, {&m.iridescence_texture, &m.film_thickness_texture});
    keep(!m.unlit && m.anisotropy > 0.0f, {&m.anisotropy_texture});
    keep(!m.unlit && m.transmission > 0.0f, {&m.transmission_texture});
    keep(!m.unlit && m.diffuse_transmission > 0.0f,
         {&m.diffuse_transmission_texture, &m.diffuse_transmission_color_texture});
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

  Color unit(const Eigen::Vector3d& values, std::string_view name) {
    return {unit(values[0], name), unit(values[1], name), unit(values[2], name)};
  }

  float unit(const json& object, const char* name, double fallback) {
    return unit(object.value(name, fallback), name);
  }

  Color unit_color(const json& object, const char* name, float fallback) {
    return unit(vector_or<Vec3>(object, name, Vec3::Constant(fallback)).cast<double>(), name);
  }

  static float normal_scale(const json& object, const char* texture) {
    return object.contains(texture) ? object[texture].value("scale", 1.0f) : 1.0f;
  }

  TextureSlot slot(const json& object, const char* name) {
    TextureSlot result;
    if (!object.contains(name)) return result;
    const json& info = object[name];
    const int index = info["index"];
    int texcoord = info.value("texCoord", 0);
    if (const json* transform = find_extension(info, "KHR_texture_transform")) {
      texcoord = transform->value("texCoord", texcoord);
      result.transform = texture_transform(*transform);
    }
    if (texcoord > 1) {
      warnings_.add(
          fmt::format("{}.{}: texCoord {} is not supported, the texture is ignored", where_, name, texcoord));
      return result;
    }
    if (image_of(document_.item("textures", index)) < 0) {
      warnings_.add(fmt::format("textures[{}]: has no image that can be read, it is ignored", index));
      return result;
    }
    result.texture = index;
    result.texcoord = texcoord;
    return result;
  }

  /// Translation * rotation * scale. The rotation is counter-clockwise as seen in the picture, where v points
  /// down from the upper left corner.
  static Eigen::Matrix<float, 2, 3> texture_transform(const json& t) {
    const auto offset = vector_or<Eigen::Vector2d>(t, "offset", Eigen::Vector2d::Zero());
    const auto scale = vector_or<Eigen::Vector2d>(t, "scale", Eigen::Vector2d::Ones());
    const double angle = t.value("rotation", 0.0);
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
  if (mode == kClampToEdge) return Wrap::clamp_to_edge;
  if (mode == kMirroredRepeat) return Wrap::mirrored_repeat;
  return Wrap::repeat;
}

}  // namespace

Material convert_material(const Document& document, int index, Warnings& warnings) {
  if (index < 0) return {};
  return Converter(document, index, warnings).convert(document.item("materials", index));
}

Texture convert_texture(const Document& document, int index) {
  const json& source = document.item("textures", index);
  Texture texture;
  texture.image = image_of(source);
  if (source.contains("sampler")) {
    const json& sampler = document.item("samplers", source["sampler"]);
    texture.wrap_s = convert_wrap(sampler.value("wrapS", kRepeat));
    texture.wrap_t = convert_wrap(sampler.value("wrapT", kRepeat));
    texture.nearest = sampler.value("magFilter", 0) == kNearest;
  }
  return texture;
}

}  // namespace gatelight::scene::gltf

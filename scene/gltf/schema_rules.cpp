#include "scene/gltf/schema.h"

#include <iterator>
#include <variant>

#include "scene/material_fields.h"

namespace gatelight::scene::gltf {
namespace {

constexpr double kByteLimit = 9007199254740992.0;  // 2^53: integers beyond it are not exact in JSON
constexpr double kIntLimit = 2147483647.0;         // the loader keeps these as int

constexpr Rule number(std::string_view owner, std::string_view name) {
  return {owner, name, Kind::number};
}
constexpr Rule numbers(std::string_view owner, std::string_view name, int length) {
  return {owner, name, Kind::number, "", Shape::list, false, length};
}
constexpr Rule integer(std::string_view owner, std::string_view name, double low, double high) {
  return {owner, name, Kind::integer, "", Shape::single, false, 0, low, high};
}
constexpr Rule integer_of(std::string_view owner, std::string_view name, std::string_view choices) {
  return {owner, name, Kind::integer, choices};
}
constexpr Rule text(std::string_view owner, std::string_view name, std::string_view choices = "") {
  return {owner, name, Kind::string, choices};
}
constexpr Rule texts(std::string_view owner, std::string_view name) {
  return {owner, name, Kind::string, "", Shape::list};
}
constexpr Rule boolean(std::string_view owner, std::string_view name) {
  return {owner, name, Kind::boolean};
}
constexpr Rule index(std::string_view owner, std::string_view name, std::string_view list) {
  return {owner, name, Kind::index, list};
}
constexpr Rule indices(std::string_view owner, std::string_view name, std::string_view list) {
  return {owner, name, Kind::index, list, Shape::list};
}
constexpr Rule object(std::string_view owner, std::string_view name, std::string_view type) {
  return {owner, name, Kind::object, type};
}
constexpr Rule objects(std::string_view owner, std::string_view name, std::string_view type) {
  return {owner, name, Kind::object, type, Shape::list};
}
constexpr Rule elements(std::string_view owner, std::string_view name, std::string_view type) {
  return {owner, name, Kind::object, type, Shape::elements};
}
constexpr Rule attributes(std::string_view owner, std::string_view name) {
  return {owner, name, Kind::index, "accessors", Shape::dictionary};
}
constexpr Rule required(Rule rule) {
  rule.required = true;
  return rule;
}
/// For values that no picture needs, or that a default can stand for.
constexpr Rule lenient(Rule rule) {
  rule.lenient = true;
  return rule;
}
constexpr Rule name(std::string_view owner) {
  return lenient(text(owner, "name"));
}
constexpr Rule positive(Rule rule) {
  rule.low = std::numeric_limits<float>::min();
  return rule;
}
constexpr Rule not_negative(Rule rule) {
  rule.low = 0.0;
  return rule;
}

// The first column is the type of the object that owns the property; "x.extensions" holds the extensions of
// x.
constexpr Rule kRules[] = {
    object("root", "asset", "asset"),
    lenient(text("asset", "version")),
    text("asset", "minVersion"),
    lenient(texts("root", "extensionsUsed")),
    texts("root", "extensionsRequired"),
    elements("root", "accessors", "accessor"),
    elements("root", "animations", "animation"),
    elements("root", "buffers", "buffer"),
    elements("root", "bufferViews", "bufferView"),
    elements("root", "cameras", "camera"),
    elements("root", "images", "image"),
    elements("root", "materials", "material"),
    elements("root", "meshes", "mesh"),
    elements("root", "nodes", "node"),
    elements("root", "samplers", "sampler"),
    elements("root", "scenes", "scene"),
    elements("root", "skins", "skin"),
    elements("root", "textures", "texture"),
    lenient(index("root", "scene", "scenes")),
    object("root", "extensions", "root.extensions"),
    object("root.extensions", "KHR_lights_punctual", "lights"),
    elements("lights", "lights", "light"),
    object("root.extensions", "EXT_lights_image_based", "image_lights"),
    elements("image_lights", "lights", "image_light"),
    name("image_light"),
    not_negative(number("image_light", "intensity")),
    numbers("image_light", "rotation", 4),
    {"image_light", "specularImages", Kind::index, "images", Shape::lists, true, 6},
    object("root.extensions", "KHR_materials_variants", "variants"),
    elements("variants", "variants", "variant"),
    required(text("variant", "name")),

    name("buffer"),
    text("buffer", "uri"),
    required(integer("buffer", "byteLength", 0, kByteLimit)),
    object("buffer", "extensions", "buffer.extensions"),
    object("buffer.extensions", "EXT_meshopt_compression", "meshopt_fallback"),
    object("buffer.extensions", "KHR_meshopt_compression", "meshopt_fallback"),
    boolean("meshopt_fallback", "fallback"),

    name("bufferView"),
    required(index("bufferView", "buffer", "buffers")),
    integer("bufferView", "byteOffset", 0, kByteLimit),
    required(integer("bufferView", "byteLength", 0, kByteLimit)),
    integer("bufferView", "byteStride", 0, kIntLimit),
    lenient(integer("bufferView", "target", 0, kIntLimit)),
    object("bufferView", "extensions", "bufferView.extensions"),
    object("bufferView.extensions", "EXT_meshopt_compression", "meshopt"),
    object("bufferView.extensions", "KHR_meshopt_compression", "meshopt"),
    required(index("meshopt", "buffer", "buffers")),
    integer("meshopt", "byteOffset", 0, kByteLimit),
    required(integer("meshopt", "byteLength", 1, kByteLimit)),
    required(integer("meshopt", "byteStride", 1, 256)),
    required(integer("meshopt", "count", 1, kIntLimit)),
    required(text("meshopt", "mode", "ATTRIBUTES|TRIANGLES|INDICES")),
    text("meshopt", "filter", "NONE|OCTAHEDRAL|QUATERNION|EXPONENTIAL|COLOR"),

    name("accessor"),
    index("accessor", "bufferView", "bufferViews"),
    integer("accessor", "byteOffset", 0, kByteLimit),
    required(integer_of("accessor", "componentType", "5120|5121|5122|5123|5125|5126")),
    lenient(boolean("accessor", "normalized")),
    required(integer("accessor", "count", 0, kByteLimit)),
    required(text("accessor", "type", "SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4")),
    object("accessor", "sparse", "sparse"),
    required(integer("sparse", "count", 0, kIntLimit)),
    required(object("sparse", "indices", "sparse.indices")),
    required(object("sparse", "values", "sparse.values")),
    required(index("sparse.indices", "bufferView", "bufferViews")),
    integer("sparse.indices", "byteOffset", 0, kIntLimit),
    required(integer_of("sparse.indices", "componentType", "5121|5123|5125")),
    required(index("sparse.values", "bufferView", "bufferViews")),
    integer("sparse.values", "byteOffset", 0, kIntLimit),

    name("mesh"),
    objects("mesh", "primitives", "primitive"),
    required(attributes("primitive", "attributes")),
    index("primitive", "indices", "accessors"),
    index("primitive", "material", "materials"),
    lenient(integer("primitive", "mode", 0, 6)),
    {"primitive", "targets", Kind::object, "target", Shape::list},
    index("target", "POSITION", "accessors"),
    index("target", "NORMAL", "accessors"),
    index("target", "TANGENT", "accessors"),
    object("primitive", "extensions", "primitive.extensions"),
    object("primitive.extensions", "KHR_draco_mesh_compression", "draco"),
    required(index("draco", "bufferView", "bufferViews")),
    required({"draco", "attributes", Kind::integer, "", Shape::dictionary, false, 0, 0, kIntLimit}),
    object("primitive.extensions", "KHR_materials_variants", "mappings"),
    required(objects("mappings", "mappings", "mapping")),
    required(index("mapping", "material", "materials")),
    required(indices("mapping", "variants", "KHR_materials_variants")),
    numbers("mesh", "weights", 0),

    name("node"),
    lenient(index("node", "camera", "cameras")),
    indices("node", "children", "nodes"),
    index("node", "mesh", "meshes"),
    index("node", "skin", "skins"),
    numbers("node", "matrix", 16),
    numbers("node", "rotation", 4),
    numbers("node", "scale", 3),
    numbers("node", "translation", 3),
    numbers("node", "weights", 0),
    {"node", "extras", Kind::anything},
    object("node", "extensions", "node.extensions"),
    lenient(object("node.extensions", "KHR_lights_punctual", "node.light")),
    required(index("node.light", "light", "KHR_lights_punctual")),
    object("node.extensions", "KHR_node_visibility", "visibility"),
    lenient(boolean("visibility", "visible")),
    object("node.extensions", "GATELIGHT_visibility", "seen_by"),
    lenient(boolean("seen_by", "camera")),
    lenient(boolean("seen_by", "diffuse")),
    lenient(boolean("seen_by", "glossy")),
    lenient(boolean("seen_by", "transmission")),
    lenient(boolean("seen_by", "volume")),
    lenient(boolean("seen_by", "shadow")),
    lenient(boolean("seen_by", "holdout")),
    lenient(boolean("seen_by", "shadowCatcher")),
    object("node.extensions", "GATELIGHT_light_linking", "light_links"),
    object("light_links", "receivers", "objects"),
    object("light_links", "blockers", "objects"),
    required(indices("objects", "nodes", "nodes")),
    lenient(boolean("objects", "exclude")),
    object("node.extensions", "EXT_mesh_gpu_instancing", "instancing"),
    required(attributes("instancing", "attributes")),

    name("scene"),
    indices("scene", "nodes", "nodes"),
    object("scene", "extensions", "scene.extensions"),
    lenient(object("scene.extensions", "EXT_lights_image_based", "scene.image_light")),
    required(index("scene.image_light", "light", "EXT_lights_image_based")),
    object("scene.extensions", "GATELIGHT_visibility", "scene.seen_by"),
    lenient(boolean("scene.seen_by", "camera")),
    lenient(boolean("scene.seen_by", "diffuse")),
    lenient(boolean("scene.seen_by", "glossy")),
    lenient(boolean("scene.seen_by", "transmission")),
    lenient(boolean("scene.seen_by", "volume")),
    object("scene.extensions", "GATELIGHT_light_linking", "light_links"),
    name("skin"),
    index("skin", "inverseBindMatrices", "accessors"),
    lenient(index("skin", "skeleton", "nodes")),
    required(indices("skin", "joints", "nodes")),

    // As join_samplers() leaves them.
    objects("animation", "channels", "channel"),
    text("channel", "pointer"),
    object("channel", "sampler", "animation.sampler"),
    required(index("animation.sampler", "input", "accessors")),
    lenient(text("animation.sampler", "interpolation", "LINEAR|STEP|CUBICSPLINE")),
    required(index("animation.sampler", "output", "accessors")),

    name("camera"),
    required(text("camera", "type", "perspective|orthographic")),
    object("camera", "perspective", "perspective"),
    object("camera", "orthographic", "orthographic"),
    lenient(positive(number("perspective", "aspectRatio"))),
    required({"perspective", "yfov", Kind::number, "", Shape::single, false, 0, 1e-6, 3.141592}),
    lenient(positive(number("perspective", "znear"))),
    lenient(positive(number("perspective", "zfar"))),
    required(number("orthographic", "xmag")),
    required(number("orthographic", "ymag")),
    lenient(number("orthographic", "znear")),
    lenient(number("orthographic", "zfar")),

    name("light"),
    lenient(text("light", "type", "directional|point|spot")),
    numbers("light", "color", 3),
    not_negative(number("light", "intensity")),
    lenient(positive(number("light", "range"))),
    lenient(object("light", "spot", "spot")),
    lenient(not_negative(number("spot", "innerConeAngle"))),
    lenient(positive(number("spot", "outerConeAngle"))),

    name("image"),
    text("image", "uri"),
    lenient(text("image", "mimeType")),
    index("image", "bufferView", "bufferViews"),
    lenient(integer_of("sampler", "magFilter", "9728|9729")),
    lenient(integer_of("sampler", "minFilter", "9728|9729|9984|9985|9986|9987")),
    lenient(integer_of("sampler", "wrapS", "33071|33648|10497")),
    lenient(integer_of("sampler", "wrapT", "33071|33648|10497")),
    name("texture"),
    lenient(index("texture", "sampler", "samplers")),
    index("texture", "source", "images"),
    object("texture", "extensions", "texture.extensions"),
    object("texture.extensions", "EXT_texture_webp", "texture.source"),
    object("texture.extensions", "KHR_texture_basisu", "texture.source"),
    object("texture.extensions", "MSFT_texture_dds", "texture.source"),
    index("texture.source", "source", "images"),

    name("material"),
    object("material", "pbrMetallicRoughness", "pbr"),
    numbers("pbr", "baseColorFactor", 4),
    object("pbr", "baseColorTexture", "textureInfo"),
    number("pbr", "metallicFactor"),
    number("pbr", "roughnessFactor"),
    object("pbr", "metallicRoughnessTexture", "textureInfo"),
    object("material", "normalTexture", "textureInfo"),
    object("material", "occlusionTexture", "textureInfo"),
    object("material", "emissiveTexture", "textureInfo"),
    numbers("material", "emissiveFactor", 3),
    lenient(text("material", "alphaMode", "OPAQUE|MASK|BLEND")),
    lenient(not_negative(number("material", "alphaCutoff"))),
    lenient(boolean("material", "doubleSided")),
    required(index("textureInfo", "index", "textures")),
    integer("textureInfo", "texCoord", 0, kIntLimit),
    number("textureInfo", "scale"),
    number("textureInfo", "strength"),
    object("textureInfo", "extensions", "textureInfo.extensions"),
    object("textureInfo.extensions", "KHR_texture_transform", "transform"),
    numbers("transform", "offset", 2),
    number("transform", "rotation"),
    numbers("transform", "scale", 2),
    integer("transform", "texCoord", 0, kIntLimit),

    object("material", "extensions", "material.extensions"),
    object("material.extensions", "KHR_materials_emissive_strength", "emissive_strength"),
    not_negative(number("emissive_strength", "emissiveStrength")),
    object("material.extensions", "KHR_materials_pbrSpecularGlossiness", "specular_glossiness"),
    numbers("specular_glossiness", "diffuseFactor", 4),
    object("specular_glossiness", "diffuseTexture", "textureInfo"),
    numbers("specular_glossiness", "specularFactor", 3),
    number("specular_glossiness", "glossinessFactor"),
    object("specular_glossiness", "specularGlossinessTexture", "textureInfo"),
    object("KHR_materials_volume", "thicknessTexture", "textureInfo"),
    numbers("KHR_materials_volume_scatter", "multiscatterColor", 3),
    object("material.extensions", "KHR_materials_scatter", "scatter"),
    number("scatter", "scatterStrengthFactor"),
    object("scatter", "scatterStrengthTexture", "textureInfo"),
    numbers("scatter", "multiscatterColorFactor", 3),
    object("scatter", "multiscatterColorTexture", "textureInfo"),
    number("scatter", "scatterAnisotropy"),
};

/// Factors up to 1 and colours are clamped where they are read; other numbers below their range are refused.
Rule rule_of_field(const MaterialField& field) {
  const FieldRange& range = field.range;
  if (std::holds_alternative<TextureSlot Material::*>(field.member))
    return object(field.extension, field.property, "textureInfo");
  if (std::holds_alternative<Color Material::*>(field.member))
    return numbers(field.extension, field.property, 3);
  const Rule rule = number(field.extension, field.property);
  if (range.min < 0.0 || range.max == 1.0) return rule;
  return range.excludes_min ? positive(rule) : not_negative(rule);
}

/// With the extensions that have members of Material. Their names are the owners of their properties.
std::vector<Rule> all_rules() {
  std::vector<Rule> rules(std::begin(kRules), std::end(kRules));
  std::string_view last;
  for (const MaterialField& field : material_fields()) {
    const std::string_view extension = field.extension, property = field.property;
    if (extension.empty()) continue;
    if (extension != last) rules.push_back(object("material.extensions", extension, extension));
    last = extension;
    // Of a texture's scale the table has a rule.
    if (!property.empty() && property.find('/') == std::string_view::npos)
      rules.push_back(rule_of_field(field));
  }
  return rules;
}

}  // namespace

std::span<const Rule> schema_rules() {
  static const std::vector<Rule> rules = all_rules();
  return rules;
}

}  // namespace gatelight::scene::gltf

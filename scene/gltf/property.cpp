#include "scene/gltf/property.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/to_number.h"
#include "scene/gltf/schema.h"

namespace gatelight::scene::gltf {
namespace {

using Names = std::span<const std::string_view>;

/// A member of one of tinygltf's generic objects.
struct ObjectMember {
  tinygltf::Value::Object* object;
  std::string name;
};

/// The value in the model. std::monostate: there is none.
using Place = std::variant<std::monostate, double*, std::vector<double>*, ObjectMember>;

/// The schema's rule of the value; null where it has none.
const Rule* rule_of(Names path) {
  using Key = std::pair<std::string_view, std::string_view>;
  static const std::map<Key, const Rule*> kByName = [] {
    std::map<Key, const Rule*> rules;
    for (const Rule& rule : schema_rules()) rules.emplace(Key(rule.owner, rule.name), &rule);
    return rules;
  }();
  std::string_view owner = "root";
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto found = kByName.find(Key(owner, path[i]));
    if (found == kByName.end()) return nullptr;
    const Rule& rule = *found->second;
    if (rule.kind != Kind::object) return i + 1 == path.size() ? &rule : nullptr;
    if (rule.shape != Shape::single) ++i;  // the name of the list, then the index
    owner = rule.target;
  }
  return nullptr;
}

/// The element of a list that a name of a pointer says; null where it is not there.
template <typename T>
T* element_named(std::vector<T>& list, std::string_view index) {
  const std::size_t number = to_number<std::size_t>(index).value_or(list.size());
  return number < list.size() ? &list[number] : nullptr;
}

/// tinygltf has dropped empty objects inside an extension: empty extensions of a texture are made again.
Place place_in(tinygltf::Value& value, Names path) {
  tinygltf::Value* owner = &value;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!owner->IsObject()) return {};
    auto& members = owner->Get<tinygltf::Value::Object>();
    std::string name(path[i]);
    if (i + 1 == path.size()) return ObjectMember{&members, std::move(name)};
    if (path[i] == "extensions" || (i > 0 && path[i - 1] == "extensions"))
      members.try_emplace(name, tinygltf::Value::Object());
    const auto member = members.find(name);
    if (member == members.end()) return {};
    owner = &member->second;
  }
  return {};
}

Place place_in(tinygltf::ExtensionMap& extensions, Names path) {
  const auto found = extensions.find(std::string(path[0]));
  return found == extensions.end() ? Place() : place_in(found->second, path.subspan(1));
}

/// Info is one of tinygltf's three types of texture references.
template <typename Info>
Place place_in_texture(Info& info, Names path) {
  return path[0] == "extensions" ? place_in(info.extensions, path.subspan(1)) : Place();
}

/// glTF forbids to animate a node with a matrix. Common viewers take the matrix apart when they load it, and
/// so does this: without shear.
void take_apart(tinygltf::Node& node) {
  const Eigen::Matrix4d m(node.matrix.data());
  Eigen::Matrix3d turn = m.topLeftCorner<3, 3>();
  Eigen::Vector3d scale = turn.colwise().norm();
  if (turn.determinant() < 0.0) scale.x() = -scale.x();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  if ((scale.array() != 0.0).all()) {
    turn *= scale.cwiseInverse().asDiagonal();
    rotation = Eigen::Quaterniond(turn).normalized();
  }
  node.matrix.clear();
  node.translation = {m(0, 3), m(1, 3), m(2, 3)};
  node.rotation = {rotation.x(), rotation.y(), rotation.z(), rotation.w()};
  node.scale = {scale.x(), scale.y(), scale.z()};
}

Place place_in_node(tinygltf::Node& node, Names path, Warnings& warnings) {
  if (path[0] == "extensions") return place_in(node.extensions, path.subspan(1));
  const bool in_matrix = path[0] == "translation" || path[0] == "rotation" || path[0] == "scale";
  if (in_matrix && !node.matrix.empty()) {
    take_apart(node);
    warnings.add("an animated node has a matrix, which is decomposed into translation, rotation and scale");
  }
  if (path[0] == "translation") return &node.translation;
  if (path[0] == "rotation") return &node.rotation;
  if (path[0] == "scale") return &node.scale;
  return {};
}

Place place_in_camera(tinygltf::Camera& camera, Names path) {
  if (path.size() != 2) return {};
  if (path[0] == "perspective") {
    if (path[1] == "yfov") return &camera.perspective.yfov;
    if (path[1] == "aspectRatio") return &camera.perspective.aspectRatio;
  } else {
    if (path[1] == "xmag") return &camera.orthographic.xmag;
    if (path[1] == "ymag") return &camera.orthographic.ymag;
  }
  return {};
}

Place place_in_light(tinygltf::Light& light, Names path) {
  if (path[0] == "color") return &light.color;
  if (path[0] == "intensity") return &light.intensity;
  if (path[0] == "range") return &light.range;
  if (path.back() == "innerConeAngle") return &light.spot.innerConeAngle;
  if (path.back() == "outerConeAngle") return &light.spot.outerConeAngle;
  return {};
}

Place place_in_material(tinygltf::Material& material, Names path) {
  const Names rest = path.subspan(1);
  if (path[0] == "extensions") return place_in(material.extensions, rest);
  if (path[0] == "alphaCutoff") return &material.alphaCutoff;
  if (path[0] == "emissiveFactor") return &material.emissiveFactor;
  if (path[0] == "emissiveTexture") return place_in_texture(material.emissiveTexture, rest);
  if (path[0] == "normalTexture") {
    if (rest[0] == "scale") return &material.normalTexture.scale;
    return place_in_texture(material.normalTexture, rest);
  }
  if (path[0] != "pbrMetallicRoughness") return {};
  tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
  if (rest[0] == "baseColorFactor") return &pbr.baseColorFactor;
  if (rest[0] == "metallicFactor") return &pbr.metallicFactor;
  if (rest[0] == "roughnessFactor") return &pbr.roughnessFactor;
  if (rest[0] == "baseColorTexture") return place_in_texture(pbr.baseColorTexture, rest.subspan(1));
  if (rest[0] == "metallicRoughnessTexture")
    return place_in_texture(pbr.metallicRoughnessTexture, rest.subspan(1));
  return {};
}

/// `path` is extensions, the name of the extension, lights, the index, and the light's member.
Place place_in_lights(tinygltf::Model& model, Names path) {
  if (path[1] == "KHR_lights_punctual") {
    tinygltf::Light* const light = element_named(model.lights, path[3]);
    return light ? place_in_light(*light, path.subspan(4)) : Place();
  }
  const auto extension = model.extensions.find(std::string(path[1]));
  if (extension == model.extensions.end() || !extension->second.Has("lights")) return {};
  auto& lights = extension->second.Get<tinygltf::Value::Object>()["lights"];
  tinygltf::Value* const light = element_named(lights.Get<tinygltf::Value::Array>(), path[3]);
  return light ? place_in(*light, path.subspan(4)) : Place();
}

/// A rule knows the path, so it is long enough.
Place place_of(tinygltf::Model& model, Names path, Warnings& warnings) {
  const Names rest = path.subspan(2);
  if (path[0] == "nodes") {
    tinygltf::Node* const node = element_named(model.nodes, path[1]);
    return node ? place_in_node(*node, rest, warnings) : Place();
  }
  if (path[0] == "materials") {
    tinygltf::Material* const material = element_named(model.materials, path[1]);
    return material ? place_in_material(*material, rest) : Place();
  }
  if (path[0] == "cameras") {
    tinygltf::Camera* const camera = element_named(model.cameras, path[1]);
    return camera ? place_in_camera(*camera, rest) : Place();
  }
  return path[0] == "extensions" && path.size() > 4 ? place_in_lights(model, path) : Place();
}

tinygltf::Value generic_value(const Rule& rule, std::span<const double> values) {
  if (rule.kind == Kind::boolean) return tinygltf::Value(values[0] != 0.0);
  if (rule.shape == Shape::single) return tinygltf::Value(values[0]);
  tinygltf::Value::Array list;
  for (const double value : values) list.emplace_back(value);
  return tinygltf::Value(std::move(list));
}

std::function<void(std::span<const double>)> setter(const Place& place, const Rule& rule) {
  using Values = std::span<const double>;
  if (auto* const* number = std::get_if<double*>(&place))
    return [value = *number](Values values) { *value = values[0]; };
  if (auto* const* numbers = std::get_if<std::vector<double>*>(&place))
    return [list = *numbers](Values values) { list->assign(values.begin(), values.end()); };
  return [member = std::get<ObjectMember>(place), &rule](Values values) {
    (*member.object)[member.name] = generic_value(rule, values);
  };
}

/// All but its setter.
Property property_of(const Rule& rule) {
  Property property;
  property.shape.components = std::max(rule.length, 1);
  property.shape.is_rotation = rule.length == 4 && rule.name == "rotation";
  property.shape.is_switch = rule.kind == Kind::boolean;
  property.low = property.below = rule.low;
  property.high = rule.high;
  // Where a file's own zero counts as missing, a zero stands for that in the model, too.
  if (rule.lenient && rule.low > 0.0) property.below = 0.0;
  return property;
}

std::size_t count_targets(const tinygltf::Mesh& mesh) {
  std::size_t count = 0;
  for (const tinygltf::Primitive& primitive : mesh.primitives)
    count = std::max(count, primitive.targets.size());
  return count;
}

/// `path` is nodes or meshes, an index, weights, and perhaps the number of a morph target.
std::optional<Property> find_weights(tinygltf::Model& model, Names path) {
  tinygltf::Node* node = nullptr;
  tinygltf::Mesh* mesh = nullptr;
  if (path[0] == "meshes") {
    mesh = element_named(model.meshes, path[1]);
  } else {
    node = element_named(model.nodes, path[1]);
    if (node && node->mesh >= 0) mesh = &model.meshes[static_cast<std::size_t>(node->mesh)];
  }
  const std::size_t targets = mesh ? count_targets(*mesh) : 0;
  if (targets == 0) return std::nullopt;
  std::vector<double>& weights = node ? node->weights : mesh->weights;
  const Rule& rule = *rule_of(path.first(3));
  Property property = property_of(rule);
  if (path.size() == 3) {
    property.shape.elements = targets;
    property.set = setter(&weights, rule);
    return property;
  }
  if (node && weights.empty()) weights = mesh->weights;
  weights.resize(targets);
  double* const weight = element_named(weights, path[3]);
  if (!weight) return std::nullopt;
  property.set = setter(weight, rule);
  return property;
}

}  // namespace

std::optional<Property> find_property(tinygltf::Model& model, std::string_view pointer, Warnings& warnings) {
  const std::vector<std::string_view> names = split_pointer(pointer);
  const Names path = names;
  const bool has_weights =
      path.size() > 2 && (path[0] == "nodes" || path[0] == "meshes") && path[2] == "weights";
  if (has_weights) return path.size() > 4 ? std::nullopt : find_weights(model, path);
  const Rule* const rule = rule_of(path);
  if (!rule) return std::nullopt;
  const bool is_number = rule->kind == Kind::number && (rule->shape == Shape::single || rule->length > 0);
  if (!is_number && rule->kind != Kind::boolean) return std::nullopt;
  const Place place = place_of(model, path, warnings);
  if (std::holds_alternative<std::monostate>(place)) return std::nullopt;

  Property property = property_of(*rule);
  property.set = setter(place, *rule);
  return property;
}

}  // namespace gatelight::scene::gltf

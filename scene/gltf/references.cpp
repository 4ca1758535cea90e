#include "scene/gltf/references.h"

#include <charconv>
#include <string>

#include "scene/gltf/unchecked.h"

namespace gatelight::scene::gltf {
namespace {

using nlohmann::json;

/// The placeholders have the members without which tinygltf refuses an element. It drops empty objects from
/// the lists of extensions, which would renumber the others.
constexpr ElementList kLists[] = {
    {"accessors", "accessor", "/accessors", R"({"componentType": 5126, "count": 0, "type": "SCALAR"})"},
    {"animations", "animation", "/animations", "{}"},
    {"buffers", "buffer", "/buffers", R"({"byteLength": 0})"},
    {"bufferViews", "bufferView", "/bufferViews", R"({"buffer": 0, "byteLength": 0})"},
    {"cameras", "camera", "/cameras",
     R"({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 1.0}})"},
    {"images", "image", "/images", "{}"},
    {"materials", "material", "/materials", "{}"},
    {"meshes", "mesh", "/meshes", R"({"primitives": []})"},
    {"nodes", "node", "/nodes", "{}"},
    {"samplers", "sampler", "/samplers", "{}"},
    {"scenes", "scene", "/scenes", R"({"nodes": []})"},
    {"skins", "skin", "/skins", R"({"joints": []})"},
    {"textures", "texture", "/textures", "{}"},
    {"KHR_lights_punctual", "light", "/extensions/KHR_lights_punctual/lights", R"({"type": "point"})"},
    {"EXT_lights_image_based", "image_light", "/extensions/EXT_lights_image_based/lights",
     R"({"intensity": 1.0})"},
    {"KHR_materials_variants", "variant", "/extensions/KHR_materials_variants/variants", "{}"},
};

}  // namespace

std::vector<std::size_t> parents_of(const json& nodes) {
  std::vector<std::size_t> parents(nodes.size(), kNoParent);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const json& child : list_of(nodes[i], "children")) {
      if (const std::optional<std::size_t> index = index_below(child, nodes.size())) parents[*index] = i;
    }
  }
  return parents;
}

References::References(json& root) {
  for (const ElementList& list : kLists) {
    List found{&list, nullptr, {}};
    const json::json_pointer place{std::string(list.place)};
    if (root.contains(place) && root.at(place).is_array()) {
      found.elements = &root.at(place);
      found.added.resize(found.elements->size());
    }
    lists_.emplace(list.name, std::move(found));
  }
  parents_ = parents_of(list_of(root, "nodes"));
}

std::size_t References::size_of(std::string_view list) const {
  return lists_.at(list).added.size();
}

bool References::hides(std::string_view pointer) const {
  for (const auto& [name, list] : lists_) {
    std::string_view rest = pointer;
    if (!rest.starts_with(list.description->place)) continue;
    rest.remove_prefix(list.description->place.size());
    if (!rest.starts_with('/')) continue;
    std::size_t index = list.added.size();
    std::from_chars(rest.data() + 1, rest.data() + rest.size(), index);
    if (index < list.added.size()) return !list.added[index];
  }
  return false;
}

void References::add(std::string_view name, std::size_t index) {
  List& list = lists_.at(name);
  while (index != kNoParent && !list.added[index]) {
    list.added[index] = true;
    waiting_.emplace_back(list.description, index);
    index = name == "nodes" ? parents_[index] : kNoParent;
  }
}

void References::add_all(std::string_view list) {
  for (std::size_t i = 0; i < size_of(list); ++i) add(list, i);
}

std::optional<References::Element> References::next() {
  if (next_ == waiting_.size()) return std::nullopt;
  return waiting_[next_++];
}

json& References::value(const Element& element) {
  return (*lists_.at(element.first->name).elements)[element.second];
}

void References::blank_others() {
  for (auto& [name, list] : lists_) {
    if (!list.elements) continue;
    const json placeholder = json::parse(list.description->placeholder);
    for (std::size_t i = 0; i < list.added.size(); ++i) {
      if (!list.added[i]) (*list.elements)[i] = placeholder;
    }
  }
}

}  // namespace gatelight::scene::gltf

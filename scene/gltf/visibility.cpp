#include "scene/gltf/visibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "scene/gltf/model.h"
#include "scene/light_names.h"
#include "scene/object_sets.h"

namespace gatelight::scene::gltf {
namespace {

constexpr const char* kLinkExtension = "GATELIGHT_light_linking";

bool flag_or(const tinygltf::Value& object, const char* name, bool fallback) {
  return object.Has(name) ? object.Get(name).Get<bool>() : fallback;
}

class LinkReader {
 public:
  LinkReader(const Document& document, const SourceNodes& nodes, Scene& scene, Warnings& warnings)
      : document_(document), nodes_(nodes), scene_(scene), warnings_(warnings) {
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
      const int node = node_of(scene.instances[i]);
      if (node >= 0) instances_[node].push_back(i);
    }
  }

  void read_all(int shown) {
    std::set<int> lit;
    for (std::size_t i = 0; i < std::min(nodes_.lights.size(), scene_.lights.size()); ++i) {
      lit.insert(nodes_.lights[i]);
      scene_.lights[i].link = link_of_node(nodes_.lights[i]);
    }
    for (Instance& instance : scene_.instances) {
      const int node = node_of(instance);
      if (node < 0 || !may_emit(scene_, scene_.material_of(instance))) continue;
      lit.insert(node);
      instance.link = link_of_node(node);
    }
    for (const auto& [node, instances] : instances_) {
      if (extension_of(node) && !lit.contains(node))
        warnings_.add(where_of(node) + ": the node has no light; it is ignored");
    }
    const tinygltf::ExtensionMap& extensions = element(document_.model().scenes, shown).extensions;
    if (const tinygltf::Value* found = find_extension(extensions, kLinkExtension))
      scene_.environment_link =
          link_of(*found, fmt::format("scenes[{}].extensions.{}", shown, kLinkExtension));
  }

 private:
  /// -1 for what a program has added.
  int node_of(const Instance& instance) const {
    const auto placement = static_cast<std::size_t>(instance.placement);
    return placement < nodes_.placements.size() ? nodes_.placements[placement] : -1;
  }

  static std::string where_of(int node) {
    return fmt::format("nodes[{}].extensions.{}", node, kLinkExtension);
  }

  const tinygltf::Value* extension_of(int node) const {
    return find_extension(element(document_.model().nodes, node).extensions, kLinkExtension);
  }

  LightLink link_of_node(int node) {
    const tinygltf::Value* const extension = extension_of(node);
    if (!extension) return {};
    const auto [link, is_new] = links_.try_emplace(node);
    if (is_new) link->second = link_of(*extension, where_of(node));
    return link->second;
  }

  LightLink link_of(const tinygltf::Value& extension, const std::string& where) {
    LightLink link;
    if (const tinygltf::Value* receivers = find_member(extension, "receivers")) {
      const ObjectSet set = read_set(*receivers, where);
      if (std::find(set.instances.begin(), set.instances.end(), 1) == set.instances.end())
        warnings_.add(where + ".receivers: no object that the scene shows is lit");
      link.receivers = number_of_set(scene_, ObjectSet(set));
    }
    if (const tinygltf::Value* blockers = find_member(extension, "blockers"))
      link.blockers = number_of_set(scene_, read_set(*blockers, where));
    return link;
  }

  ObjectSet read_set(const tinygltf::Value& objects, const std::string& where) const {
    const bool exclude = flag_or(objects, "exclude", false);
    document_.claim(scene_.instances.size(), where);
    ObjectSet set{std::vector<std::uint8_t>(scene_.instances.size(), exclude ? 1 : 0), exclude};
    for (const tinygltf::Value& node : array_of(objects, "nodes")) {
      const auto found = instances_.find(node.GetNumberAsInt());
      if (found == instances_.end()) continue;
      for (const std::size_t instance : found->second) set.instances[instance] = exclude ? 0 : 1;
    }
    return set;
  }

  const Document& document_;
  const SourceNodes& nodes_;
  Scene& scene_;
  Warnings& warnings_;
  std::map<int, std::vector<std::size_t>> instances_;  ///< by the node
  std::map<int, LightLink> links_;                     ///< by the node
};

}  // namespace

Visibility read_visibility(const tinygltf::ExtensionMap& extensions) {
  Visibility visibility;
  const tinygltf::Value* const extension = find_extension(extensions, kVisibilityExtension);
  if (!extension) return visibility;
  for (const auto& [name, kind] : kRayKindNames) {
    if (!flag_or(*extension, name, true)) visibility.rays &= static_cast<RayKinds>(~kind);
  }
  visibility.holdout = flag_or(*extension, "holdout", false);
  visibility.shadow_catcher = flag_or(*extension, "shadowCatcher", false);
  return visibility;
}

void read_light_links(const Document& document, int shown, const SourceNodes& nodes, Scene& scene,
                      Warnings& warnings) {
  const auto has_link = [](const auto& owner) {
    return find_extension(owner.extensions, kLinkExtension) != nullptr;
  };
  const tinygltf::Model& model = document.model();
  if (std::any_of(model.nodes.begin(), model.nodes.end(), has_link) || has_link(element(model.scenes, shown)))
    LinkReader(document, nodes, scene, warnings).read_all(shown);
}

}  // namespace gatelight::scene::gltf

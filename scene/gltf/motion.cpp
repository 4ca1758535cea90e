#include "scene/gltf/motion.h"

#include <string_view>
#include <vector>

#include "base/to_number.h"
#include "scene/gltf/visibility.h"

namespace gatelight::scene::gltf {
namespace {

using PointerNames = std::vector<std::string_view>;

void note_node(const PointerNames& path, Motion& motion) {
  const std::size_t index = to_number<std::size_t>(path[1]).value_or(motion.nodes.size());
  if (index >= motion.nodes.size()) return;
  NodeMotion& node = motion.nodes[index];
  if (path[2] == "weights") {
    node.weights = true;
  } else if (path.size() > 4 && path[3] == kVisibilityExtension) {
    node.seen_by = true;
  } else if (path.back() == "visible") {
    node.visibility = true;
  } else {
    node.place = true;
  }
}

void note_mesh(const Document& document, const PointerNames& path, Motion& motion) {
  const std::optional<int> mesh = to_number<int>(path[1]);
  for (std::size_t i = 0; i < motion.nodes.size(); ++i) {
    const tinygltf::Node& node = document.model().nodes[i];
    if (node.weights.empty() && node.mesh == mesh) motion.nodes[i].weights = true;
  }
}

}  // namespace

Motion find_motion(const Document& document) {
  Motion motion{.nodes = std::vector<NodeMotion>(document.model().nodes.size())};
  for (const Channel& channel : document.channels()) {
    const PointerNames path = split_pointer(channel.pointer);
    if (path.size() < 3) continue;
    const std::string_view list = path[0];
    if (list == "nodes") note_node(path, motion);
    if (list == "meshes") note_mesh(document, path, motion);
    const bool images = path[1] == "EXT_lights_image_based";
    motion.image_light |= list == "extensions" && images;
    motion.lights |= list == "extensions" && !images;
    motion.materials |= list == "materials";
  }
  return motion;
}

}  // namespace gatelight::scene::gltf

#include "scene/gltf/motion.h"

#include <charconv>
#include <string_view>

namespace gatelight::scene::gltf {
namespace {

/// Takes the first name off a JSON pointer.
std::string_view next_name(std::string_view& pointer) {
  pointer.remove_prefix(1);
  const std::string_view name = pointer.substr(0, pointer.find('/'));
  pointer.remove_prefix(name.size());
  return name;
}

std::size_t number_of(std::string_view text, std::size_t otherwise) {
  std::size_t number = otherwise;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

void note_node(const Channel& channel, std::string_view rest, Motion& motion) {
  const std::size_t count = motion.nodes.size();
  const std::size_t index = number_of(next_name(rest), count);
  if (index >= count) return;
  NodeMotion& node = motion.nodes[index];
  if (rest.starts_with("/weights")) {
    node.weights = true;
  } else if (channel.pointer.ends_with("/visible")) {
    node.visibility = true;
  } else {
    node.place = true;
  }
}

void note_mesh(const Document& document, std::string_view rest, Motion& motion) {
  const std::size_t index = number_of(next_name(rest), document.model().meshes.size());
  for (std::size_t i = 0; i < motion.nodes.size(); ++i) {
    const tinygltf::Node& node = document.model().nodes[i];
    if (node.weights.empty() && node.mesh == static_cast<int>(index)) motion.nodes[i].weights = true;
  }
}

}  // namespace

Motion find_motion(const Document& document) {
  Motion motion{.nodes = std::vector<NodeMotion>(document.model().nodes.size())};
  for (const Channel& channel : document.channels()) {
    std::string_view rest = channel.pointer;
    if (!rest.starts_with('/')) continue;
    const std::string_view list = next_name(rest);
    if (rest.empty()) continue;
    if (list == "nodes") note_node(channel, rest, motion);
    if (list == "meshes") note_mesh(document, rest, motion);
    const bool images = rest.starts_with("/EXT_lights_image_based");
    motion.image_light |= list == "extensions" && images;
    motion.lights |= list == "extensions" && !images;
    motion.materials |= list == "materials";
  }
  return motion;
}

}  // namespace gatelight::scene::gltf

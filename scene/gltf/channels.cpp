#include "scene/gltf/channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/gltf/unchecked.h"

namespace gatelight::scene::gltf {
namespace {

using nlohmann::json;

constexpr std::pair<std::string_view, Interpolation> kInterpolations[] = {
    {"STEP", Interpolation::step},
    {"LINEAR", Interpolation::linear},
    {"CUBICSPLINE", Interpolation::cubic_spline}};

Interpolation interpolation_of(const json& sampler) {
  const std::string name = text_of(sampler, "interpolation");
  for (const auto& [known, interpolation] : kInterpolations) {
    if (known == name) return interpolation;
  }
  return Interpolation::linear;
}

/// An index that an unchecked object has; nothing where it has no such member.
std::optional<std::size_t> checked_index(const json& object, const char* name, std::string_view list,
                                         std::size_t count, std::string_view file, const std::string& where) {
  const auto member = object.find(name);
  if (member == object.end()) return std::nullopt;
  const std::optional<std::size_t> index = index_of(object, name, count);
  if (index) return index;
  throw make_error(file, fmt::format("{}.{}", where, name),
                   fmt::format("{}, expected an index into {} (of size {})",
                               member->dump(-1, ' ', false, json::error_handler_t::replace), list, count));
}

}  // namespace

std::vector<std::string_view> split_pointer(std::string_view pointer) {
  std::vector<std::string_view> names;
  while (pointer.starts_with('/')) {
    pointer.remove_prefix(1);
    const std::size_t end = std::min(pointer.find('/'), pointer.size());
    names.push_back(pointer.substr(0, end));
    pointer.remove_prefix(end);
  }
  return names;
}

std::string pointer_of(const json& channel) {
  const auto target = channel.find("target");
  if (target == channel.end()) return "";
  const std::string path = text_of(*target, "path");
  if (path == "pointer") {
    const auto extensions = target->find("extensions");
    if (extensions == target->end()) return "";
    const auto extension = extensions->find("KHR_animation_pointer");
    return extension == extensions->end() ? "" : text_of(*extension, "pointer");
  }
  const std::optional<std::size_t> node = index_of(*target, "node", std::size_t{1} << 31);
  return path.empty() || !node ? "" : fmt::format("/nodes/{}/{}", *node, path);
}

void join_samplers(json& animation, std::size_t index, const References& references, std::string_view file,
                   Warnings& warnings) {
  if (!animation.is_object() || list_of(animation, "channels").empty()) return;
  const json& samplers = list_of(animation, "samplers");
  json& channels = animation["channels"];
  for (std::size_t i = 0; i < channels.size(); ++i) {
    json& channel = channels[i];
    if (!channel.is_object()) continue;
    const std::string where = fmt::format("animations[{}].channels[{}]", index, i);
    if (const auto target = channel.find("target"); target != channel.end())
      checked_index(*target, "node", "nodes", references.size_of("nodes"), file, where + ".target");
    std::string pointer = pointer_of(channel);
    if (pointer.empty()) warnings.add(where + ": no target; the channel is ignored");
    if (pointer.empty() || references.hides(pointer)) {
      channel = json::object();
      continue;
    }
    const std::optional<std::size_t> sampler =
        checked_index(channel, "sampler", "samplers", samplers.size(), file, where);
    if (!sampler) throw make_error(file, where + ".sampler", "missing, expected an index into samplers");
    channel = {{"pointer", std::move(pointer)}, {"sampler", samplers[*sampler]}};
  }
}

std::vector<Channel> take_channels(json& root) {
  std::vector<Channel> taken;
  const json& animations = list_of(root, "animations");
  for (std::size_t a = 0; a < animations.size(); ++a) {
    const json& channels = list_of(animations[a], "channels");
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (channels[i].empty()) continue;
      const json& sampler = channels[i]["sampler"];
      taken.push_back({fmt::format("animations[{}].channels[{}]", a, i), text_of(channels[i], "pointer"),
                       sampler["input"], sampler["output"], interpolation_of(sampler)});
    }
  }
  root.erase("animations");
  return taken;
}

}  // namespace gatelight::scene::gltf

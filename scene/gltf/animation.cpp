#include "scene/gltf/animation.h"

#include <fmt/format.h>

#include <set>
#include <span>
#include <utility>

namespace gatelight::scene::gltf {

Animator::Animator(Document& document, Warnings& warnings) {
  CurveReader reader(document, warnings);
  std::set<std::string> animated;
  for (const Channel& channel : document.channels()) {
    std::optional<Property> property = find_property(document.model(), channel.pointer, warnings);
    if (!property) {
      warnings.add(
          fmt::format("{}: '{}' cannot be animated here and is ignored", channel.where, channel.pointer));
      continue;
    }
    std::optional<Curve> curve = reader.read(channel, property->shape);
    if (!curve) continue;
    if (!animated.insert(channel.pointer).second)
      warnings.add(
          fmt::format("{}: a second channel for {}; the last one is used", channel.where, channel.pointer));
    tracks_.push_back({channel.pointer, *std::move(curve), *std::move(property)});
  }
}

void Animator::apply(double seconds, Warnings& warnings, bool before) const {
  for (const Track& track : tracks_) {
    const Property& property = track.property;
    Eigen::VectorXd value = evaluate(track.curve, seconds, before);
    for (double& number : value) {
      if (number >= property.low && number <= property.high) continue;
      warnings.add(
          fmt::format("{}: {:g} at {:g} s is out of range and clamped", track.pointer, number, seconds));
      number = number > property.high ? property.high : property.below;
    }
    property.set({value.data(), static_cast<std::size_t>(value.size())});
  }
}

}  // namespace gatelight::scene::gltf

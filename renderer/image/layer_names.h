#pragma once
// What layers show, by the names that renderers give them.

#include <string>

namespace gatelight::renderer {

enum class LayerRole { beauty, noisy, albedo, normal, other };

struct LayerMeaning {
  LayerRole role = LayerRole::other;
  int rank = 0;       ///< of the name among those of its role: the least comes first
  std::string group;  ///< the rest of the name, which layers of one view layer and eye have in common
};

/// "ViewLayer.Denoising Albedo" is an albedo of the group "ViewLayer", "albedo" one of the group "". Case,
/// spaces, hyphens and underscores are ignored. "ViewLayer.Combined.left" is a beauty of the group
/// "ViewLayer.left".
LayerMeaning meaning_of(const std::string& layer);

/// The usual name of a channel that is spelt in another way: "R" for "r", "red" and "Red". Others stay.
std::string usual_channel(const std::string& channel);

}  // namespace gatelight::renderer

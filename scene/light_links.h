#pragma once
// Chooses which objects the lights of a loaded scene light, and which cast shadows in their light.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace gatelight::scene {

struct LightLinkRule {
  /// Name of a punctual light or an emissive material, where a '*' at its end matches any ending; or
  /// kEnvironmentWord.
  std::string light;
  bool blockers = false;           ///< else receivers
  bool exclude = false;            ///< all but these nodes; else only these
  std::vector<std::string> nodes;  ///< names of nodes; a '*' at their ends matches any ending

  bool operator==(const LightLinkRule&) const = default;
};

/// Links the lights. All rules of a light make one set of receivers, or of blockers, which replaces that of
/// the file: the nodes of the rules that do not exclude, or all objects and fog if there are none, without
/// those that rules exclude. A set of chosen nodes is without fog. Throws InputError if a name matches
/// nothing, if a light lights no object, or if there are too many sets (scene/object_sets.h). Call it also
/// without rules, after adjust_lights().
void link_lights(Scene& scene, const std::vector<LightLinkRule>& rules);

}  // namespace gatelight::scene

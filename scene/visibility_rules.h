#pragma once
// Changes which rays see objects, lamps and the environment of a loaded scene.

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace gatelight::scene {

struct VisibilityRule {
  /// Name of a node or of a punctual light, where a '*' at its end matches any ending; or kEnvironmentWord.
  std::string name;
  RayKinds on = 0;
  RayKinds off = 0;
  std::optional<RayKinds> only;  ///< all others are off; `on` and `off` come after it
  std::optional<bool> holdout;

  bool operator==(const VisibilityRule&) const = default;
};

/// Applies the rules in this order, to what the file says. Kinds of rays that light nothing by a lamp are
/// ignored there. Throws InputError if a name matches nothing, and if no ray sees an object any more or a
/// lamp lights nothing.
void apply_visibility(Scene& scene, const std::vector<VisibilityRule>& rules);

/// The same for another time of this scene, at which the rules were checked before.
void apply_visibility_again(Scene& scene, const std::vector<VisibilityRule>& rules);

}  // namespace gatelight::scene

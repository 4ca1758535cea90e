#pragma once
// The lights of a scene by their names.

#include <set>
#include <string>

#include "base/errors.h"
#include "scene/scene.h"

namespace gatelight::scene {

/// Whether a light's name is the wanted one, whose '*' at its end stands for any further letters.
bool fits_light_name(const std::string& wanted, const std::string& name);

/// "lights 'a', 'b'"; at most as many names as fit into a line.
std::string list_names(const char* what, const std::set<std::string>& names);

/// Whether it emits, or would without adjust_lights(), or may at another time.
bool may_emit(const Scene& scene, const Material& material);

/// The names of punctual lights and of emissive materials.
struct LightNames {
  std::set<std::string> lights;
  std::set<std::string> materials;  ///< including those that adjust_lights() made black

  explicit LightNames(const Scene& scene);
  /// Problem, expected and hint: "there is no light 'lamb', expected one of its lights 'lamp'; did you mean
  /// 'lamp'?". `word` is a further valid name; empty means none.
  ErrorParts no_such_light(const std::string& wanted, const std::string& word = "") const;
};

}  // namespace gatelight::scene

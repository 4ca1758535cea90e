#pragma once
// The objects of a scene by their names.

#include <set>
#include <string>

#include "base/errors.h"
#include "scene/scene.h"

namespace gatelight::scene {

/// The names of instances and of punctual lights.
struct ObjectNames {
  std::set<std::string> objects;
  std::set<std::string> lights;

  explicit ObjectNames(const Scene& scene);
  /// Problem, expected and hint: "there is no object 'wal', expected one of its objects 'floor', 'wall'; did
  /// you mean 'wall'?". `with_lights`: lights and the environment are valid, too.
  ErrorParts no_such_object(const std::string& wanted, bool with_lights) const;
};

}  // namespace gatelight::scene

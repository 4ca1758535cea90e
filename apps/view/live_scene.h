#pragma once
// The scene of a window: its file at some time, with factors for its lights.

#include <string>
#include <vector>

#include "scene/gltf.h"

namespace gatelight::apps {

class LiveScene {
 public:
  /// Loads the file and shows `options.time`, or 0 s, and `options.lights`. Throws InputError.
  LiveScene(const std::string& path, const scene::LoadOptions& options);

  const scene::Scene& scene() const { return scene_; }
  /// Shows another time, and other factors in place of the earlier ones. Returns whether the scene is another
  /// one now. Throws InputError for unknown lights, with the earlier factors in place.
  bool show(double seconds, const std::vector<scene::LightAdjustment>& lights);

 private:
  void keep_lights();
  void restore_lights();

  scene::SceneFile file_;
  scene::Scene scene_;
  double seconds_;
  std::vector<scene::LightAdjustment> lights_;
  std::vector<Color> intensities_;  ///< of the file's punctual lights, at this time
  std::vector<Color> emissions_;    ///< of its materials
};

}  // namespace gatelight::apps

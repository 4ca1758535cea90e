#pragma once
// The scene of a window: its file at some time, with changes to its lights and to what rays see.

#include <string>
#include <utility>
#include <vector>

#include "scene/gltf.h"

namespace gatelight::apps {

/// The members of LoadOptions, besides the time, that a window changes.
struct SceneChanges {
  std::vector<scene::LightAdjustment> lights;
  std::vector<scene::VisibilityRule> visibility;
  std::vector<scene::LightLinkRule> light_links;

  bool operator==(const SceneChanges&) const = default;
};

SceneChanges changes_of(const scene::LoadOptions& options);

class LiveScene {
 public:
  /// Loads the file and shows `options.time`, or 0 s, with the options' changes. Throws InputError.
  LiveScene(const std::string& path, const scene::LoadOptions& options);

  const scene::Scene& scene() const { return scene_; }
  /// Shows another time, and other changes in place of the earlier ones. Returns whether the scene is another
  /// one now. Throws InputError for unknown names, with the earlier changes in place.
  bool show(double seconds, const SceneChanges& changes);

 private:
  /// What changes replace, as the file has it at this time.
  struct Originals {
    std::vector<Color> intensities;  ///< of punctual lights
    std::vector<Color> emissions;    ///< of materials
    std::vector<std::pair<scene::RayKinds, scene::LightLink>> lights;
    std::vector<std::pair<scene::Visibility, scene::LightLink>> instances;
    scene::RayKinds environment_rays;
    scene::LightLink environment_link;
    std::vector<scene::ObjectSet> object_sets;
  };

  void keep();
  void restore();
  void apply(const SceneChanges& changes);

  scene::SceneFile file_;
  scene::Scene scene_;
  double seconds_;
  SceneChanges changes_;
  Originals originals_;
};

}  // namespace gatelight::apps

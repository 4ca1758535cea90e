#pragma once
// Gives lights of a loaded file the profiles of IES files.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace gatelight::scene {

struct LightProfile {
  std::string name;  ///< name of point and spot lights; a '*' at its end matches any ending
  std::string file;

  bool operator==(const LightProfile&) const = default;
};

/// Turns the lights into point lights. Their intensity becomes the maximum, and the profile scales it in
/// other directions. If several profiles match a light, only the last one applies. Throws InputError if a
/// file is not a valid profile, or if a name matches no point or spot light.
void give_profiles(Scene& scene, const std::vector<LightProfile>& profiles);

}  // namespace gatelight::scene

#pragma once
// Gives lights of a loaded file the profiles of IES files.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace gatelight::scene {

struct LightProfile {
  std::string name;  ///< name of point and spot lights; a '*' at its end stands for any further letters
  std::string file;

  bool operator==(const LightProfile&) const = default;
};

/// The lights become point lights. Their intensity is kept as the greatest one and varies as the profile's.
/// Where several profiles name a light, the last one counts. Throws InputError for files that are no
/// profiles, and for a name that no point or spot light has.
void give_profiles(Scene& scene, const std::vector<LightProfile>& profiles);

}  // namespace gatelight::scene

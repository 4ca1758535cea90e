#pragma once
// Switches lights of a loaded file off, makes them brighter or darker, or colours them.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace gatelight::scene {

/// A factor for all lights with a matching name.
struct LightAdjustment {
  /// Name of a punctual light or an emissive material. A '*' at its end matches any ending.
  std::string name;
  Color factor{1.0f, 1.0f, 1.0f};  ///< linear; not negative; zero switches off

  bool operator==(const LightAdjustment& other) const {
    return name == other.name && (factor == other.factor).all();
  }
};

/// Multiplies the intensity of punctual lights and the emission of materials. If several adjustments match a
/// light, only the last one applies: {"*", 0}, {"lamp", 1} switches off all but the lamp. Throws InputError
/// if a product is not finite, or if a name matches no light and no emissive material. In a file with
/// animations, other materials match too.
void adjust_lights(Scene& scene, const std::vector<LightAdjustment>& adjustments);

}  // namespace gatelight::scene

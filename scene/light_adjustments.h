#pragma once
// Switches lights of a loaded file off, makes them brighter or darker, or colours them.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace gatelight::scene {

/// A factor for the lights of a name.
struct LightAdjustment {
  /// Name of a punctual light or an emissive material. A '*' at its end stands for any further letters.
  std::string name;
  Color factor{1.0f, 1.0f, 1.0f};  ///< linear; not negative; zero switches off

  bool operator==(const LightAdjustment& other) const {
    return name == other.name && (factor == other.factor).all();
  }
};

/// Multiplies the intensity of punctual lights and the emission of materials. Where several adjustments name
/// a light, the last one counts: {"*", 0}, {"lamp", 1} switches off all but the lamp. Throws InputError for a
/// name that no light and no emissive material has (of a file with animations: no material), and where a product is not finite.
void adjust_lights(Scene& scene, const std::vector<LightAdjustment>& adjustments);

}  // namespace gatelight::scene

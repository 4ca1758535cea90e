#pragma once
// What the chosen animations of a document change.

#include <vector>

#include "scene/gltf/document.h"

namespace gatelight::scene::gltf {

/// What changes of a node itself, not by its parents.
struct NodeMotion {
  bool place = false;  ///< translation, rotation or scale
  bool weights = false;
  bool visibility = false;  ///< KHR_node_visibility
  bool seen_by = false;     ///< GATELIGHT_visibility
  /// The largest angle in radians by which its rotation turns in an interval of the open shutter.
  double turn = 0.0;
};

struct Motion {
  std::vector<NodeMotion> nodes;
  bool lights = false;  ///< their properties, not their nodes
  bool image_light = false;
  bool materials = false;
  bool turns = false;  ///< some NodeMotion::turn is not 0
};

Motion find_motion(const Document& document);

}  // namespace gatelight::scene::gltf

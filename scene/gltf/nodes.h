#pragma once
// The node hierarchy, flattened: what stands where in the world.

#include <string>
#include <vector>

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace gatelight::scene::gltf {

/// A glTF mesh (all its primitives) in the world.
struct Placement {
  int mesh = -1;  ///< of the file
  std::string name;
  Affine transform = Affine::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< the transform's, with all its digits
};

struct Graph {
  std::vector<Placement> placements;
  std::vector<PunctualLight> lights;
  std::vector<Camera> cameras;
  std::vector<Eigen::Vector3d> light_positions, camera_positions;  ///< of each, with all their digits
};

/// Walks scene `scene` (-1: the file's default, or its first). Checks the whole hierarchy: cycles, several
/// parents, numbers that are not finite. Throws SceneError.
Graph flatten_nodes(const Document& document, int scene, Warnings& warnings);

}  // namespace gatelight::scene::gltf

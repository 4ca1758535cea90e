#pragma once
// Flattens the node hierarchy into meshes, lights and cameras in world space.

#include <string>
#include <vector>

#include "scene/gltf/document.h"
#include "scene/gltf/motion.h"
#include "scene/gltf/pose.h"
#include "scene/scene.h"

namespace gatelight::scene::gltf {

/// A glTF mesh (all its primitives) in the world.
struct Placement {
  int pose = -1;     ///< into Graph::poses
  int node = -1;     ///< its index in the file
  std::string name;  ///< Instance::name
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  float dielectric_priority = 0.0f;  ///< Instance::dielectric_priority
  bool moves = false;                ///< Instance::moves
  bool hidden = false;               ///< Instance::hidden
  Visibility visibility;             ///< Instance::visibility
  double turn = 0.0;                 ///< of its node and those above (NodeMotion::turn)
};

/// The transform in single precision.
inline Affine rounded(const Eigen::Affine3d& transform) {
  Affine result;
  result.matrix() = transform.matrix().topRows<3>().cast<float>();
  return result;
}

struct Graph {
  std::vector<Pose> poses;
  std::vector<std::vector<JointMatrix>> joints;  ///< of each of the file's skins that a pose has; else empty
  std::vector<Placement> placements;
  std::vector<PunctualLight> lights;
  std::vector<int> light_nodes;  ///< their indices in the file
  std::vector<Camera> cameras;
  std::vector<char> deforming;      ///< by the pose
  std::vector<double> pose_turns;   ///< by the pose: the largest of a joint
  std::vector<double> light_turns;  ///< by the light
  double camera_turn = 0.0;         ///< the largest of a camera
  bool lights_move = false;
};

/// Walks the scene of the options. Poses and placements are the same ones at all times: what is hidden for a
/// while is hidden then. All places are those from `origin` (Scene::origin), from which they are taken in
/// double. Throws InputError for cycles, several parents and transforms that are not finite.
Graph flatten_nodes(const Document& document, const Motion& motion, const LoadOptions& options,
                    const Vec3& origin, Warnings& warnings);

}  // namespace gatelight::scene::gltf

#pragma once
// The deformation of a file's mesh where nodes place it.

#include <vector>

#include "base/math.h"

namespace gatelight::scene::gltf {

/// From the mesh at rest to the world: the joint's transform times its inverse bind matrix.
using JointMatrix = Eigen::Matrix<float, 3, 4>;

/// Nodes with equal poses share their vertices.
struct Pose {
  int mesh = -1;                ///< index in the file
  std::vector<double> weights;  ///< of the morph targets; empty where all are zero
  int skin = -1;                ///< index in the file
  int node = -1;                ///< that whose weights change with the time; else -1

  auto operator<=>(const Pose&) const = default;
};

}  // namespace gatelight::scene::gltf

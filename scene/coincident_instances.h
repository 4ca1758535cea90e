#pragma once
// Instances with surfaces in the same place.

#include <cstdint>
#include <map>
#include <vector>

#include "scene/scene.h"

namespace gatelight::scene {

/// Whether light passes the surfaces of an instance, which keep their shape over time.
bool lets_light_pass(const Scene& scene, const Instance& instance);

/// An instance that lets light pass, and one that coincides with it.
struct InstancePair {
  std::uint32_t passing, other;

  auto operator<=>(const InstancePair&) const = default;
};

/// Whether some triangles of a pair face the same way, and some opposite ways.
struct Facing {
  bool same = false, opposite = false;
};

struct CoincidentInstances {
  std::map<InstancePair, Facing> pairs;
  /// By instance, in metres: at least how far from its triangles rays start. Empty without pairs.
  std::vector<float> offsets;
};

/// Finds pairs of instances with triangles that lie in one plane, up to the sum of their offsets, and overlap
/// there. In scenes with millions of triangles that let light pass, as leaves do, it looks for none. Works in
/// the caller's arena.
CoincidentInstances find_coincident_instances(const Scene& scene);

}  // namespace gatelight::scene

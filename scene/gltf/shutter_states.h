#pragma once
// Collects the states of an open shutter.

#include <set>

#include "scene/gltf/nodes.h"
#include "scene/gltf/parts.h"
#include "scene/gltf/shutter_times.h"
#include "scene/scene.h"

namespace gatelight::scene::gltf {

/// What turns further has more states: the intervals of the shutter are divided into more parts for it.
class ShutterStates {
 public:
  /// The graph is of any time, with the turns of the shutter.
  ShutterStates(const Scene& scene, const Graph& graph, const Parts& parts, const ShutterTimes& times);

  /// The numbers of parts, ascending. For each the states are added in order.
  const std::set<int>& divisions() const { return divisions_; }
  /// Bytes of all states to come.
  std::size_t bytes() const;

  /// The cameras and lights.
  void add(const Graph& graph, int division);
  bool wants_transform(std::size_t instance, int division) const { return transforms_[instance] == division; }
  bool wants_vertices(std::size_t mesh, int division) const { return vertices_[mesh] == division; }
  void add_transform(std::size_t instance, const Instance& moved);
  /// May be called for several meshes at once.
  void add_vertices(std::size_t mesh, Mesh&& deformed);

  /// Box around an instance in its last state.
  Box bounds(std::size_t instance) const;

  /// Drops what stood still.
  ShutterMotion finish();

 private:
  int divide(double turn);

  const Scene& scene_;
  const ShutterTimes& times_;
  std::set<int> divisions_;
  // The parts of what the lists of motion_ hold; 0: it stands still.
  std::vector<int> transforms_, vertices_, lights_;
  int cameras_ = 0;
  std::vector<char> seen_;  ///< instances that are not hidden all the time
  ShutterMotion motion_;
};

}  // namespace gatelight::scene::gltf

#pragma once
// Collects the states of an open shutter.

#include "scene/gltf/nodes.h"
#include "scene/scene.h"
#include "scene/shutter.h"

namespace gatelight::scene::gltf {

/// Takes kShutterKeys states, in order.
class ShutterStates {
 public:
  /// The scene must outlive this object.
  explicit ShutterStates(const Scene& scene);

  /// The cameras, and the lights if they move.
  void add(const Graph& graph, bool lights);
  void add_transform(std::size_t instance, const Affine& transform);
  /// May be called for several meshes at once.
  void add_vertices(std::size_t mesh, Mesh&& deformed);

  /// Of the last state of the mesh.
  const PaddedVector<Vec3>& positions(std::size_t mesh) const;

  /// Drops what stood still.
  ShutterMotion finish();

 private:
  const Scene& scene_;
  ShutterMotion motion_;
};

}  // namespace gatelight::scene::gltf

#include "scene/gltf/shutter_states.h"

#include <algorithm>
#include <utility>

namespace gatelight::scene::gltf {
namespace {

bool same(const Affine& a, const Affine& b) {
  return a.matrix() == b.matrix();
}

bool same(const Camera& a, const Camera& b) {
  return same(a.transform, b.transform) && a.vertical_fov == b.vertical_fov && a.half_height == b.half_height;
}

bool same(const auto& a, const auto& b) {
  return a == b;
}

/// Empties the lists whose states are all alike. Returns whether one remains.
template <typename State>
bool keep_moving(std::vector<std::vector<State>>& lists) {
  bool any = false;
  for (std::vector<State>& states : lists) {
    const auto stands = [&](const State& state) { return same(state, states.front()); };
    if (std::all_of(states.begin(), states.end(), stands)) states.clear();
    any |= !states.empty();
  }
  return any;
}

}  // namespace

ShutterStates::ShutterStates(const Scene& scene) : scene_(scene) {
  motion_.is_open = true;
  motion_.transforms.resize(scene.instances.size());
  motion_.vertices.resize(scene.meshes.size());
  motion_.cameras.resize(scene.cameras.size());
  motion_.lights.resize(scene.lights.size());
}

void ShutterStates::add(const Graph& graph, bool lights) {
  for (std::size_t i = 0; i < graph.cameras.size(); ++i) motion_.cameras[i].push_back(graph.cameras[i]);
  if (!lights) return;
  for (std::size_t i = 0; i < graph.lights.size(); ++i) {
    const PunctualLight& light = graph.lights[i];
    motion_.lights[i].push_back({light.position, light.direction, light.side});
  }
}

void ShutterStates::add_transform(std::size_t instance, const Affine& transform) {
  motion_.transforms[instance].push_back(transform);
}

void ShutterStates::add_vertices(std::size_t mesh, Mesh&& deformed) {
  motion_.vertices[mesh].push_back(
      {std::move(deformed.positions), std::move(deformed.normals), std::move(deformed.tangents)});
}

const PaddedVector<Vec3>& ShutterStates::positions(std::size_t mesh) const {
  return motion_.vertices[mesh].empty() ? scene_.meshes[mesh].positions
                                        : motion_.vertices[mesh].back().positions;
}

ShutterMotion ShutterStates::finish() {
  motion_.instances = keep_moving(motion_.transforms);
  motion_.instances |= keep_moving(motion_.vertices);
  keep_moving(motion_.lights);
  keep_moving(motion_.cameras);
  return std::move(motion_);
}

}  // namespace gatelight::scene::gltf

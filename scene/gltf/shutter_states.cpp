#include "scene/gltf/shutter_states.h"

#include <algorithm>
#include <utility>

#include "scene/shutter.h"

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

ShutterStates::ShutterStates(const Scene& scene, const Graph& graph, const Parts& parts,
                             const ShutterTimes& times)
    : scene_(scene),
      times_(times),
      transforms_(scene.instances.size(), 0),
      vertices_(scene.meshes.size(), 0),
      lights_(scene.lights.size(), 0),
      seen_(scene.instances.size(), 0) {
  motion_.is_open = true;
  motion_.clock = times.clock();
  motion_.transforms.resize(scene.instances.size());
  motion_.vertices.resize(scene.meshes.size());
  motion_.cameras.resize(scene.cameras.size());
  motion_.lights.resize(scene.lights.size());
  for (std::size_t i = 0; i < transforms_.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (instance.moves) transforms_[i] = divide(element(graph.placements, instance.placement).turn);
  }
  for (std::size_t m = 0; m < vertices_.size(); ++m) {
    const int part = scene.meshes[m].deforming;
    if (part >= 0)
      vertices_[m] = divide(element(graph.pose_turns, parts[static_cast<std::size_t>(part)].pose));
  }
  for (std::size_t i = 0; scene.motion.lights && i < lights_.size(); ++i)
    lights_[i] = divide(graph.light_turns[i]);
  cameras_ = divide(graph.camera_turn);
}

int ShutterStates::divide(double turn) {
  return *divisions_.insert(parts_of_turn(turn, times_.intervals())).first;
}

std::size_t ShutterStates::bytes() const {
  std::size_t bytes = 0;
  const auto states = [&](int parts) { return static_cast<std::size_t>(parts * times_.intervals() + 1); };
  for (const int parts : transforms_) bytes += parts > 0 ? states(parts) * sizeof(Affine) : 0;
  for (std::size_t m = 0; m < vertices_.size(); ++m) {
    const Mesh& mesh = scene_.meshes[m];
    if (vertices_[m] == 0) continue;
    bytes +=
        states(vertices_[m]) * (mesh.positions.size() * sizeof(Vec3) + mesh.normals.size() * sizeof(Vec3) +
                                mesh.tangents.size() * sizeof(Vec4));
  }
  return bytes;
}

void ShutterStates::add(const Graph& graph, int division) {
  for (std::size_t i = 0; cameras_ == division && i < graph.cameras.size(); ++i)
    motion_.cameras[i].push_back(graph.cameras[i]);
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    if (lights_[i] != division) continue;
    const PunctualLight& light = graph.lights[i];
    motion_.lights[i].push_back({light.position, light.direction, light.side});
  }
}

void ShutterStates::add_transform(std::size_t instance, const Instance& moved) {
  // Embree has no states without a transform, so a hidden one is a speck.
  constexpr float kSpeck = 1e-5f;
  motion_.transforms[instance].push_back(moved.transform);
  if (moved.hidden) {
    motion_.transforms[instance].back().linear() *= kSpeck;
  } else {
    seen_[instance] = 1;
  }
}

void ShutterStates::add_vertices(std::size_t mesh, Mesh&& deformed) {
  motion_.vertices[mesh].push_back(
      {std::move(deformed.positions), std::move(deformed.normals), std::move(deformed.tangents)});
}

Box ShutterStates::bounds(std::size_t instance) const {
  const Instance& placed = scene_.instances[instance];
  const std::vector<DeformedVertices>& vertices = motion_.vertices[static_cast<std::size_t>(placed.mesh)];
  const std::vector<Affine>& transforms = motion_.transforms[instance];
  const Affine& transform = transforms.empty() ? placed.transform : transforms.back();
  Box box;
  for (const Vec3& p : vertices.empty() ? scene_.mesh_of(placed).positions : vertices.back().positions)
    box.extend(transform * p);
  return box;
}

ShutterMotion ShutterStates::finish() {
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    if (!seen_[i]) motion_.transforms[i].clear();
  }
  motion_.instances = keep_moving(motion_.transforms);
  motion_.instances |= keep_moving(motion_.vertices);
  keep_moving(motion_.lights);
  keep_moving(motion_.cameras);
  return std::move(motion_);
}

}  // namespace gatelight::scene::gltf

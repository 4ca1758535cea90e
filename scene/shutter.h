#pragma once
// Movement while a shutter is open (Scene::shutter). A time in [0, 1] goes from its opening to its closing.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace gatelight::scene {

/// Number of states that are kept of what moves. An arc of a quarter turn is then approximated within 0.5 %
/// of its radius.
inline constexpr int kShutterKeys = 9;

/// The middle of the shutter: the time of the scene itself.
inline constexpr float kShutterMiddle = 0.5f;

/// The time of a state.
constexpr float time_of_key(int key) {
  return static_cast<float>(key) / (kShutterKeys - 1);
}

/// The states before and after a time, and how far it is between them, in [0, 1].
template <typename State>
struct StatesAround {
  const State& before;
  const State& after;
  float fraction;
};

/// `states` has at least two elements.
template <typename State>
StatesAround<State> states_around(const std::vector<State>& states, float time) {
  const float place = time * static_cast<float>(states.size() - 1);
  const std::size_t index = std::min(static_cast<std::size_t>(std::max(place, 0.0f)), states.size() - 2);
  return {states[index], states[index + 1], place - static_cast<float>(index)};
}

/// Linear, exact at both ends.
template <typename Value>
Value between(const Value& a, const Value& b, float fraction) {
  return Value((1.0f - fraction) * a + fraction * b);
}

/// An attribute of a vertex.
template <typename Attribute>
auto attribute_at(const std::vector<DeformedVertices>& states, float time, std::uint32_t vertex,
                  Attribute DeformedVertices::*attribute) {
  const StatesAround<DeformedVertices> around = states_around(states, time);
  return between((around.before.*attribute)[vertex], (around.after.*attribute)[vertex], around.fraction);
}

Affine transform_at(const std::vector<Affine>& states, float time);
/// Unit directions.
LightPlace light_at(const std::vector<LightPlace>& states, float time);

/// Whether the instance moves, or its mesh deforms, while the shutter is open.
bool is_blurred(const Scene& scene, std::size_t instance);

/// world_triangle() of scene.h at a time.
std::array<Vec3, 3> world_triangle_at(const Scene& scene, std::size_t instance, std::uint32_t primitive,
                                      float time);

}  // namespace gatelight::scene

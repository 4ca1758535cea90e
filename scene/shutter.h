#pragma once
// Movement while a shutter is open (Scene::shutter). A time in [0, 1] goes from its opening to its closing,
// as states and rays have it: by a clock it may go faster, slower, or in a jump (ShutterMotion::clock).

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace gatelight::scene {

/// Number of states that are kept of what moves, where nothing turns far, bends or jumps.
inline constexpr int kShutterKeys = 9;

/// The largest number of intervals between states. Embree takes 129 states.
inline constexpr int kMaxShutterIntervals = 128;

/// The number of parts in which all `intervals` are divided for what turns by this angle in one, in radians.
/// The angle of a part is at most 0.1, where a chord is nearer to the axis than its arc by an 800th of the
/// radius; for what turns further than kMaxShutterIntervals allow, it is larger.
int parts_of_turn(double turn, int intervals);

/// The middle of the shutter: the time of the scene itself.
inline constexpr float kShutterMiddle = 0.5f;

/// The time of a state, one of `count`.
constexpr float time_of_state(std::size_t state, std::size_t count) {
  return static_cast<float>(state) / static_cast<float>(count - 1);
}

/// The time at which a clock shows `seen`, in [0, 1), and the reverse.
float time_by_clock(const std::vector<float>& clock, float seen);
float clock_at(const std::vector<float>& clock, float time);

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
Camera camera_at(const std::vector<Camera>& states, float time);
/// Unit directions.
LightPlace light_at(const std::vector<LightPlace>& states, float time);

/// Whether the instance moves, or its mesh deforms, while the shutter is open.
bool is_blurred(const Scene& scene, std::size_t instance);

/// The number of states in which it does so; 0: none.
std::size_t count_states(const Scene& scene, std::size_t instance);

/// world_triangle() of scene.h at a time.
std::array<Vec3, 3> world_triangle_at(const Scene& scene, std::size_t instance, std::uint32_t primitive,
                                      float time);

}  // namespace gatelight::scene

#pragma once
// A homogeneous medium that absorbs and scatters light, and the distances between scattering events in it.

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/math.h"

namespace gatelight::renderer {

/// The single-scattering albedo of a medium whose half space has the diffuse reflectance `multiple`, in
/// [0, 1]: Kulla and Conty 2017, "Revisiting physically based shading at Imageworks", a fit of van de Hulst's
/// similarity; KHR_materials_volume_scatter uses it too. `g`: anisotropy of the phase function.
inline Color single_scattering_albedo(const Color& multiple, float g) {
  const Color m = multiple.max(0.0f).min(1.0f);
  const Color s =
      (4.09712f + 4.20863f * m - (9.59217f + 41.6808f * m + 17.7126f * m * m).sqrt()).max(0.0f).min(1.0f);
  return ((1.0f - s * s) / (1.0f - g * s * s)).max(0.0f).min(1.0f);
}

/// Distances along a ray, in metres.
struct Span {
  float begin = 0.0f;
  float end = 0.0f;

  float length() const { return end - begin; }
  /// The length that lies after a distance.
  float after(float distance) const { return std::max(0.0f, end - std::max(begin, distance)); }
};

/// The part of [0, end] in which a ray is in a box; empty where it misses it.
inline Span clip(const Box& box, const Vec3& origin, const Vec3& direction, float end) {
  Span span{0.0f, end};
  for (int axis = 0; axis < 3; ++axis) {
    const float low = box.min()[axis] - origin[axis], high = box.max()[axis] - origin[axis];
    if (direction[axis] == 0.0f) {
      if (low > 0.0f || high < 0.0f) return {};
      continue;
    }
    const float a = low / direction[axis], b = high / direction[axis];
    span = {std::max(span.begin, std::min(a, b)), std::min(span.end, std::max(a, b))};
  }
  return span.begin < span.end ? span : Span{};
}

/// Coefficients per metre.
struct ScatteringMedium {
  Color extinction{0.0f, 0.0f, 0.0f};  ///< absorption and scattering
  Color albedo{0.0f, 0.0f, 0.0f};      ///< the part of the extinction that is scattering
  float anisotropy = 0.0f;             ///< of phase()
  bool scatters = false;               ///< paths walk through it, event by event
  Color color{0.0f, 0.0f, 0.0f};       ///< the reflectance of a half space
  /// Whether light samples reach its inside: shadow rays pass its boundary, or it has none.
  bool sampled = false;
  std::optional<Box> box = {};  ///< where it ends, if no surfaces enclose it

  /// The part of a ray of this length, between surfaces of the medium or in its box, in which it is there.
  Span within(const Vec3& origin, const Vec3& direction, float length) const {
    return box ? clip(*box, origin, direction, length) : Span{0.0f, length};
  }
};

/// The channel by which a distance is sampled, and the probability of each: in proportion to what each would
/// carry on.
struct ChannelChoice {
  int channel = 0;
  Color probability{0.0f, 0.0f, 0.0f};

  /// `throughput` is that of the path. `u` in [0, 1).
  ChannelChoice(const ScatteringMedium& medium, const Color& throughput, float u) {
    probability = throughput * medium.albedo;
    float sum = probability.sum();
    if (!(sum > 0.0f)) {
      probability = throughput;
      sum = probability.sum();
    }
    probability = sum > 0.0f ? Color(probability / sum) : Color(Color::Constant(1.0f / 3.0f));
    while (channel < 2 && u >= probability[channel]) u -= probability[channel++];
    while (channel > 0 && !(probability[channel] > 0.0f)) --channel;
  }
};

/// The distance to an event by one channel, for `u` in [0, 1); infinite in a clear channel.
inline float sample_distance(const ScatteringMedium& medium, const ChannelChoice& choice, float u) {
  const float extinction = medium.extinction[choice.channel];
  return extinction > 0.0f ? -std::log1p(-u) / extinction : kInfinity;
}

/// The density, per metre, of a flight that ends by an event at this distance, by any of the channels.
inline float flight_density(const ScatteringMedium& medium, const ChannelChoice& choice, float distance) {
  return (choice.probability * medium.extinction * (-medium.extinction * distance).exp()).sum();
}

/// The weight of a flight that ends by an event at this distance, or without one at the end of the medium:
/// transmittance, times scattering at an event, over the probability. Sampling by any of the channels counts
/// (one-sample multiple importance sampling with the balance heuristic), so that the weight of no channel
/// exceeds one over the probability of that channel.
inline Color flight_weight(const ScatteringMedium& medium, const ChannelChoice& choice, float distance,
                           bool scatters) {
  const Color transmittance = (-medium.extinction * distance).exp();
  const Color density = scatters ? Color(medium.extinction * transmittance) : transmittance;
  const float all = (choice.probability * density).sum();
  if (!(all > 0.0f)) return Color::Zero();
  return scatters ? Color(density * medium.albedo / all) : Color(density / all);
}

}  // namespace gatelight::renderer

#pragma once
// A homogeneous medium that absorbs and scatters light, and the distances between scattering events in it.

#include <algorithm>
#include <cmath>

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

/// Coefficients per metre.
struct ScatteringMedium {
  Color extinction{0.0f, 0.0f, 0.0f};  ///< absorption and scattering
  Color albedo{0.0f, 0.0f, 0.0f};      ///< the part of the extinction that is scattering
  float anisotropy = 0.0f;             ///< of phase()
  Color color{0.0f, 0.0f, 0.0f};       ///< the reflectance of a half space
  /// Whether light samples reach its inside: shadow rays pass its boundary.
  bool sampled = false;

  bool scatters() const { return (albedo * extinction > 0.0f).any(); }
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

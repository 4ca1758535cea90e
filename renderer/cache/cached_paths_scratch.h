#pragma once
// The memory in which one thread follows its paths.

#include <vector>

#include "renderer/cache/cached_paths.h"

namespace gatelight::renderer {

struct CachedPaths::Path {
  Ray ray;
  RayCone cone;
  Color throughput{1.0f, 1.0f, 1.0f};  ///< for Russian roulette alone
  Color passed{1.0f, 1.0f, 1.0f};      ///< panes and media since `vertex`
  Color absorption{0.0f, 0.0f, 0.0f};  ///< per metre, of the medium the ray travels in
  Departure departure;
  Sampler sampler;
  float radiance_scale = 1.0f;  ///< product of BsdfSample::radiance_scale
  float spread = 0.0f;          ///< metres: root of the area over which the path has spread
  float first_spread = 0.0f;    ///< square metres: of the eye's ray at the first surface
  std::int32_t vertex = kNone;  ///< that the ray left from
  std::uint32_t index = 0;      ///< into the starts
  std::uint32_t seed = 0;
  std::uint16_t depth = 0;     ///< scattering events so far
  std::uint16_t surfaces = 0;  ///< met so far: the block of sampler dimensions
  std::uint16_t wide_events = 0;
  std::uint16_t records = 0;
  bool to_its_end = false;
  bool emission_only = false;  ///< the next surface or sky is looked at for its emission alone
};

struct CachedPaths::Scratch {
  struct Pending {
    std::int32_t vertex = kNone;
    Color direct = Color::Zero();
    Color held = Color::Zero();
  };
  std::vector<Path> paths;
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  std::vector<Ray> shadow_rays;
  std::vector<Pending> pending;
  std::vector<Color> transmittance;
};

}  // namespace gatelight::renderer

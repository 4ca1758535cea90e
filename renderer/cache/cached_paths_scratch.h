#pragma once
// The memory in which one thread follows its paths.

#include "renderer/cache/cached_paths.h"
#include "renderer/transport/waves.h"

namespace gatelight::renderer {

/// What of the light that a path meets next belongs to the vertex that it left from: scattering there, panes
/// and media since.
struct CachedPaths::Links {
  Color emission{1.0f, 1.0f, 1.0f};   ///< of what shines
  Color scattered{1.0f, 1.0f, 1.0f};  ///< of what is reflected
  Color held = Color::Zero();         ///< to H of the vertex, where it is a record

  void operator*=(const Color& passed) {
    emission *= passed;
    scattered *= passed;
    held *= passed;
  }
};

struct CachedPaths::Path {
  RayCone cone;
  Color throughput{1.0f, 1.0f, 1.0f};  ///< of power, for Russian roulette alone
  Links links;
  Color absorption{0.0f, 0.0f, 0.0f};  ///< per metre, of the medium the ray travels in
  Departure departure;
  Sampler sampler;
  float spread = 0.0f;          ///< metres: root of the area over which the path has spread
  float first_spread = 0.0f;    ///< square metres: of the eye's ray at the first surface
  std::int32_t vertex = kNone;  ///< that the ray left from; kNone: the camera
  std::uint32_t index = 0;      ///< into the starts
  std::uint32_t seed = 0;
  std::int32_t depth = 0;     ///< scattering events so far
  std::int32_t surfaces = 0;  ///< met so far: the block of sampler dimensions
  std::int32_t wide_events = 0;
  std::int32_t records = 0;
  bool to_its_end = false;
  bool emission_only = false;  ///< the next surface or sky is looked at for its emission alone
};

/// A light sample on its way to a vertex.
struct CachedPaths::Pending {
  std::int32_t vertex = kNone;
  Color direct = Color::Zero();
  Color held = Color::Zero();
};

struct CachedPaths::Scratch : Waves<CachedPaths::Path, CachedPaths::Pending> {};

}  // namespace gatelight::renderer

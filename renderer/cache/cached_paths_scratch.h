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

struct CachedPaths::Path : Walker {
  Links links;
  float spread = 0.0f;          ///< metres: root of the area over which the path has spread
  float first_spread = 0.0f;    ///< square metres: of the eye's ray at the first surface
  std::int32_t vertex = kNone;  ///< that the ray left from; kNone: the camera
  std::int32_t wide_events = 0;
  std::int32_t records = 0;
  bool to_its_end = false;

  Path() = default;
  Path(const PathStart& start, std::size_t which)
      : Walker(start.sample, which), to_its_end(start.to_its_end) {}
};

/// A light sample on its way to a vertex.
struct CachedPaths::Pending {
  std::int32_t vertex = kNone;
  Color direct = Color::Zero();
  Color held = Color::Zero();
};

struct CachedPaths::Scratch : Waves<CachedPaths::Path, CachedPaths::Pending> {};

}  // namespace gatelight::renderer

#pragma once
// Follows paths that may end in the cache: the path tracer's neighbour, with the same light sampling.

#include <span>
#include <vector>

#include "neural/layout/surface_layout.h"
#include "renderer/cache/held_light.h"
#include "renderer/cache/path_batch.h"
#include "renderer/settings/statistics.h"
#include "renderer/transport/walker.h"
#include "renderer/transport/waves.h"

namespace gatelight::renderer {

/// Which surfaces have storage.
class StoredSurfaces {
 public:
  /// All: what a hash grid has.
  StoredSurfaces() = default;
  /// sides: those of each instance that have storage. A side without counts as stored only where materials
  /// do not tell it from the other: the back of what is double-sided may lie in another light.
  StoredSurfaces(const scene::Scene& scene, std::span<const neural::Sides> sides);

  bool operator()(std::uint32_t surface) const { return all_ || stored_[surface] != 0; }

 private:
  bool all_ = true;
  std::vector<std::uint8_t> stored_;
};

/// Where paths end and what they leave.
struct PathPlan {
  QueryAt query_at = QueryAt::none;
  bool records = false;  ///< every vertex of wide lobes that does not end in the cache becomes a record
  int end_after_records = kNone;  ///< a path with so many ends in the cache; kNone: query_at decides
  int most_records = kNone;       ///< of a path; kNone: no limit
  int max_depth = 8;              ///< scattering events
  int min_depth = 2;              ///< before Russian roulette
};

/// Where a path begins: a camera ray, or any ray whose nearest hit is known already.
struct PathStart {
  CameraSample sample;
  bool to_its_end = false;  ///< whatever end_after_records says
};

/// What the paths read of the options.
struct CachedPathsOptions {
  MisRule mis;
  HeldLight held;
  float min_roughness = 0.0f;     ///< perceptual; narrower lobes are not asked for
  float spread_threshold = 0.0f;  ///< of QueryAt::spread, over the spread at the first surface
};
inline CachedPathsOptions cached_paths_options(const RenderOptions& options) {
  return {{options.direct, options.mis},
          {options.cache.holds},
          options.cache.min_roughness,
          options.cache.spread_threshold};
}

class CachedPaths {
 public:
  struct Scratch;

  /// The world and the surfaces outlive it.
  CachedPaths(const World& world, const CachedPathsOptions& options, const StoredSurfaces& stored)
      : walk_{world, options.mis},
        options_(options),
        stored_(stored),
        delta_lights_(world.lights.has_delta()) {}

  /// Traces. `hits` is empty, or has the nearest hit of each start's ray. `first_hits` is empty or as long as
  /// the starts. Afterwards batch.queries wait for answers and batch.resolve() for them. Thread-safe.
  void trace(std::span<const PathStart> starts, std::span<const Hit> hits, const PathPlan& plan,
             PathBatch& batch, std::span<FirstHit> first_hits, RayCounts& rays, Scratch& scratch) const;

 private:
  struct Links;
  struct Path;
  struct Pending;
  bool scatter(Path& path, Ray& ray, const Hit& hit, const PathPlan& plan, PathBatch& batch,
               std::span<FirstHit> first_hits, Scratch& scratch) const;
  bool ends_here(const Path& path, const PathPlan& plan) const;
  bool answer(Path& path, const Meeting& m, std::uint32_t side, PathBatch& batch, Scratch& scratch) const;
  bool continue_from(Path& path, const Meeting& m, std::uint32_t side, bool record, const PathPlan& plan,
                     PathBatch& batch, Scratch& scratch) const;
  /// links: from `vertex` on, unless the path only passes a pane.
  bool advance(Path& path, const Meeting& m, const Drawn& drawn, const Links& links,
               std::int32_t vertex) const;
  void add_emission(const Path& path, const Emission& emission, PathBatch& batch) const;
  /// A light sample of `bsdf` to `vertex`. wide: the lobes whose share the cache holds; null where the vertex
  /// is no record.
  void add_light(const Path& path, const Meeting& m, const Bsdf& bsdf, LightKinds kinds, const Bsdf* wide,
                 std::int32_t vertex, Scratch& scratch) const;

  Walk walk_;
  CachedPathsOptions options_;
  const StoredSurfaces& stored_;
  bool delta_lights_;
};

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

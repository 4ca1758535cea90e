#pragma once
// Follows paths that may end in a query of the cache. Light sampling is the same as in the path tracer.

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
  /// All surfaces, as for a hash grid.
  StoredSurfaces() = default;
  /// sides: those of each instance that have storage. Where materials show one side only, both count as
  /// stored if one is. The two sides of double-sided materials count separately, because they may be lit
  /// differently.
  StoredSurfaces(const scene::Scene& scene, std::span<const neural::Sides> sides);

  bool operator()(std::uint32_t surface) const { return all_ || stored_[surface] != 0; }

 private:
  bool all_ = true;
  std::vector<std::uint8_t> stored_;
};

/// Where paths end and which records they make.
struct PathPlan {
  QueryAt query_at = QueryAt::none;
  bool records = false;  ///< every vertex of wide lobes that does not end in the cache becomes a record
  int end_after_records = kNone;  ///< a path ends in the cache after so many records; kNone: query_at decides
  /// Find for each path where it first meets a wide surface, and ask the cache there (PathBatch::guides).
  bool guides = false;
  /// The paths are samples of the picture as well, which end in the cache there (PathBatch::ends).
  QueryAt samples_at = QueryAt::none;
  int most_records = kNone;  ///< for each path; kNone: no limit
  int max_depth = 8;         ///< scattering events
  int min_depth = 2;         ///< before Russian roulette
  /// Light samples whose light over the vertex's reflectance is below this are traced by Russian roulette.
  /// 0: CameraSample::faint of the path decides.
  float faint = 0.0f;
};

/// The start of a path: a camera ray, or any ray whose nearest hit is already known.
struct PathStart {
  CameraSample sample;
  bool to_its_end = false;  ///< regardless of end_after_records
  bool on_surface = false;  ///< not at the camera
};

/// The options that these paths read.
struct CachedPathsOptions {
  MisRule mis;
  HeldLight held;
  float min_roughness = 0.0f;     ///< perceptual; the cache does not hold narrower lobes
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

  /// The world and `stored` must outlive the object.
  CachedPaths(const World& world, const CachedPathsOptions& options, const StoredSurfaces& stored)
      : walk_(world, options.mis),
        options_(options),
        stored_(stored),
        delta_apart_(world.lights.has_delta() && !options.held.light_sample(true)) {
    walk_.shading.tell_wide(options.min_roughness);
  }

  /// Traces the paths. `hits` is empty or has the nearest hit of each start's ray. `first_hits` is empty or
  /// as long as the starts. Afterwards the caller answers batch.queries and calls batch.resolve().
  /// Thread-safe.
  void trace(std::span<const PathStart> starts, std::span<const Hit> hits, const PathPlan& plan,
             PathBatch& batch, std::span<FirstHit> first_hits, RayCounts& rays, Scratch& scratch) const;

 private:
  struct Links;
  struct Path;
  struct Pending;
  /// The kinds of blocks: paths that end in the cache there, paths of which the narrow lobes alone go on, and
  /// paths that go on.
  enum BlockKind : std::uint8_t { kAnswers, kSplits, kScatters };

  PathBlock* scatter(std::uint32_t number, Path& path, Ray& ray, const Hit& hit, const PathPlan& plan,
                     PathBatch& batch, std::span<FirstHit> first_hits, Scratch& scratch) const;
  /// What the kernels do where a path can end in the cache.
  BlockKind kind_of_end(const SurfaceMaterial& material) const;
  void shade(PathBlock& block, const PathPlan& plan, PathBatch& batch, std::span<FirstHit> first_hits,
             Scratch& scratch) const;
  std::uint32_t side_at(const Hit& hit, bool front) const;
  /// The point of a lane. wide_albedo: of the wide lobes.
  SurfacePoint point_at(const PathBlock& block, int lane, const Hit& hit, const Color& wide_albedo) const;
  /// Adds a vertex that the cache answers, if it can. Returns its number.
  std::int32_t ask(const Path& path, const SurfacePoint& point, PathBatch& batch) const;
  /// Whether a path looks for its guide. PathBatch::guides has its place then.
  static bool seeks_guide(const Path& path, const PathBatch& batch);
  /// Makes a vertex the guide of its path. stored: the cache can be asked there.
  void set_guide(const Path& path, const SurfacePoint& point, bool stored, std::int32_t vertex,
                 PathBatch& batch) const;
  /// Adds a vertex that goes on. record: it becomes a record, if it can; then it stays true.
  std::int32_t add_vertex(Path& path, const SurfacePoint& point, bool& record, const PathPlan& plan,
                          PathBatch& batch) const;
  /// Whether a vertex of a path may become a record, storage provided.
  bool may_teach(const Path& path, const PathPlan& plan) const;
  bool ends_here(const Path& path, const PathPlan& plan) const;
  bool ends_at(const Path& path, QueryAt place) const;
  bool answer(Path& path, const Meeting& m, std::uint32_t side, const PathPlan& plan, PathBatch& batch,
              Scratch& scratch) const;
  /// For a lane that is shaded.
  void continue_from(Path& path, const PathBlock& block, int lane, const PathPlan& plan, PathBatch& batch,
                     Scratch& scratch) const;
  /// Adds the light sample of a lane to `vertex`, unless roulette ends it.
  void add_light(const Path& path, const ShadingBlock& points, int lane, bool record, bool guides,
                 std::int32_t vertex, const PathPlan& plan, Scratch& scratch) const;
  /// Makes the next ray of a lane, if it has one.
  void follow(Path& path, const PathBlock& block, int lane, const Drawn& drawn, const Links& links,
              std::int32_t vertex, Scratch& scratch) const;
  bool continue_from(Path& path, const Meeting& m, std::uint32_t side, bool record, const PathPlan& plan,
                     PathBatch& batch, Scratch& scratch) const;
  /// `links` apply from `vertex` on, unless the path only passes a pane.
  void link(Path& path, const Drawn& drawn, const Links& links, std::int32_t vertex) const;
  bool advance(Path& path, const Meeting& m, const Drawn& drawn, const Links& links,
               std::int32_t vertex) const;
  void add_emission(const Path& path, const Emission& emission, PathBatch& batch) const;
  /// Adds a light sample of `bsdf` to `vertex`. wide: the lobes whose share the cache holds; null where the
  /// vertex is neither a record nor a guide.
  void add_light(const Path& path, const Meeting& m, const Bsdf& bsdf, LightKinds kinds, const Bsdf* wide,
                 std::int32_t vertex, Scratch& scratch) const;

  Walk walk_;
  CachedPathsOptions options_;
  const StoredSurfaces& stored_;
  bool delta_apart_;  ///< the light of punctual lights is sampled where paths end in the cache
};

/// Factors from the light that a path finds next to the vertex that it left: scattering there, and the
/// transmittance of panes and media since.
struct CachedPaths::Links {
  Color emission{1.0f, 1.0f, 1.0f};   ///< of emission
  Color scattered{1.0f, 1.0f, 1.0f};  ///< of reflected light
  Color held = Color::Zero();         ///< to H of the vertex (held_light.h), where it is a record

  void operator*=(const Color& passed) {
    emission *= passed;
    scattered *= passed;
    held *= passed;
  }
};

struct CachedPaths::Path : Walker {
  Links links;
  float spread = 0.0f;          ///< metres: root of the area over which the path has spread
  float first_spread = 0.0f;    ///< square metres: of the camera ray at the first surface
  std::int32_t vertex = kNone;  ///< that the ray left; kNone: the camera
  std::int32_t wide_events = 0;
  std::int32_t records = 0;
  bool to_its_end = false;

  Path() = default;
  Path(const World& world, const PathStart& start, std::size_t which)
      : Walker(world, start.sample, which, start.on_surface ? Interior() : world.around_camera),
        to_its_end(start.to_its_end) {}
};

/// A light sample of a vertex whose shadow ray has not been traced yet.
struct CachedPaths::Pending {
  std::int32_t vertex = kNone;
  Color direct = Color::Zero();
  Color held = Color::Zero();
  Color apart = Color::Zero();  ///< of delta lights, by the wide lobes, where the cache does not hold it
};

struct CachedPaths::Scratch : Waves<CachedPaths::Path, CachedPaths::Pending> {};

}  // namespace gatelight::renderer

#pragma once
// Follows paths that may end in a query of the cache. Light sampling is the same as in the path tracer.

#include <optional>
#include <span>
#include <vector>

#include "neural/layout/surface_layout.h"
#include "renderer/cache/cached_light.h"
#include "renderer/cache/path_batch.h"
#include "renderer/settings/statistics.h"
#include "renderer/transport/lobe_shares.h"
#include "renderer/transport/path_state.h"
#include "renderer/transport/waves.h"

namespace gatelight::renderer {

/// The set of surfaces that have storage.
class StoredSurfaces {
 public:
  /// All surfaces, as for a hash grid.
  StoredSurfaces() = default;
  /// sides: the sides of each instance that have storage. Where materials show one side only, both count as
  /// stored if one is. The two sides of double-sided materials count separately, because they may be lit
  /// differently.
  StoredSurfaces(const scene::Scene& scene, std::span<const neural::Sides> sides);

  bool operator()(std::uint32_t surface) const { return all_ || stored_[surface] != 0; }

 private:
  bool all_ = true;
  std::vector<std::uint8_t> stored_;
};

/// Settings for the ends of paths and for their records.
struct PathPlan {
  QueryAt query_at = QueryAt::none;
  bool records = false;           ///< vertices with wide lobes become records, unless the path ends there
  int end_after_records = kNone;  ///< a path ends in the cache after these; kNone: query_at decides
  /// Query the cache at the first wide surface of each path (PathBatch::guides).
  bool guides = false;
  /// The paths are samples of the picture as well, and as such end in the cache here (PathBatch::ends).
  QueryAt samples_at = QueryAt::none;
  bool passes = false;            ///< the parts of the light of CachedPathsOptions::passes are wanted
  int most_records = kNone;       ///< for each path; kNone: no limit
  int max_depth = kNoDepthLimit;  ///< scattering events
  int min_depth = 2;              ///< before Russian roulette
  /// Light samples whose light over the vertex's reflectance is below this are traced by Russian roulette.
  /// 0: CameraSample::contribution_threshold of the path decides.
  float contribution_threshold = 0.0f;
};

/// The start of a path: a camera ray, or any ray whose nearest hit is already known.
struct PathStart {
  CameraSample sample;
  bool to_its_end = false;  ///< regardless of end_after_records
};

/// The options that these paths read.
struct CachedPathsOptions {
  MisRule mis;
  int max_transmission_depth = kNoDepthLimit;
  CachedLight cached;
  float min_roughness = 0.0f;     ///< perceptual; narrower lobes are not cached
  float spread_threshold = 0.0f;  ///< of QueryAt::spread, over the spread at the first surface
  std::vector<Aov> passes;        ///< render passes of the samples of the picture
};
inline CachedPathsOptions cached_paths_options(const RenderOptions& options) {
  return {{options.direct, options.mis},  options.max_transmission_depth.value_or(kNoDepthLimit),
          {options.cache.component},      options.cache.min_roughness,
          options.cache.spread_threshold, passes_among(options.aovs)};
}

class CachedPaths {
 public:
  struct Scratch;

  /// The world and `stored` must outlive the object.
  CachedPaths(const World& world, const CachedPathsOptions& options, const StoredSurfaces& stored)
      : context_(world, options.mis, options.max_transmission_depth),
        options_(options),
        stored_(stored),
        separate_delta_(world.lights.has_delta() && !options.cached.light_sample(true)) {
    context_.shading.separate_wide(options.min_roughness);
    if (options.passes.empty()) return;
    diffuse_shading_.emplace(context_.shading);
    diffuse_shading_->separate_wide(kOnlyDiffuse);
  }

  /// Traces the paths. `hits` is empty or has the nearest hit of each start's ray. `first_hits` is empty or
  /// as long as the starts. Afterwards the caller answers batch.queries and calls batch.resolve().
  /// Thread-safe.
  void trace(std::span<const PathStart> starts, std::span<const Hit> hits, const PathPlan& plan,
             PathBatch& batch, std::span<FirstHit> first_hits, RayCounts& rays, Scratch& scratch) const;

 private:
  struct VertexWeights;
  struct Path;
  struct Pending;
  /// The kinds of blocks: paths that end in the cache with all lobes, paths that end there with the wide
  /// lobes only, and paths that continue.
  enum BlockKind : std::uint8_t { kCacheOnly, kCacheAndNarrow, kContinue };

  PathBlock* scatter(std::uint32_t number, Path& path, Ray& ray, Hit& hit, const PathPlan& plan,
                     PathBatch& batch, std::span<FirstHit> first_hits, RayCounts& counts,
                     Scratch& scratch) const;
  /// Walks through the medium around a path. False: the path ends there.
  bool walk(Path& path, Ray& ray, Hit& hit, const PathPlan& plan, PathBatch& batch, FirstHit* first,
            RayCounts& counts, Scratch& scratch) const;
  BlockKind kind_of(const Path& path, const SurfaceInteraction& m, bool kernels, const PathPlan& plan) const;
  void shade(PathBlock& block, const PathPlan& plan, PathBatch& batch, std::span<FirstHit> first_hits,
             Scratch& scratch) const;
  std::uint32_t side_at(const Hit& hit, bool front) const;
  /// The point of a lane. wide_albedo: the albedo of the wide lobes.
  SurfacePoint point_at(const PathBlock& block, int lane, const Hit& hit, const Color& wide_albedo) const;
  /// Adds a vertex, with a query if it is worth caching. Returns its number.
  std::int32_t add_query_vertex(const Path& path, const SurfacePoint& point, PathBatch& batch) const;
  /// Whether a path still needs its guide. PathBatch::guides has an entry for it then.
  static bool seeks_guide(const Path& path, const PathBatch& batch);
  /// Makes a vertex the guide of its path. stored: the cache can be queried there.
  void set_guide(const Path& path, const SurfacePoint& point, bool stored, std::int32_t vertex,
                 PathBatch& batch) const;
  /// Adds a vertex where the path continues. record: it becomes a record; set to false where it cannot.
  std::int32_t add_vertex(Path& path, const SurfacePoint& point, bool& record, const PathPlan& plan,
                          PathBatch& batch) const;
  /// Whether a vertex of a path may become a record if it has storage.
  bool may_record(const Path& path, const PathPlan& plan) const;
  bool ends_here(const Path& path, const PathPlan& plan) const;
  bool ends_at(const Path& path, QueryAt place) const;
  /// Continues the path of a shaded lane.
  void continue_from(Path& path, const PathBlock& block, int lane, const PathPlan& plan, PathBatch& batch,
                     Scratch& scratch) const;
  /// Shades a copy of a block, whose diffuse lobes are separate; `all_lobes`: scatter() shades the block.
  void shade_diffuse(const PathBlock& block, bool all_lobes, PathBlock& copy) const;
  /// Adds the light sample of a lane to `vertex`, unless roulette ends it.
  void add_light(const Path& path, const PathBlock& block, int lane, bool record, bool guides,
                 std::int32_t vertex, const LobeShare& lobes, const PathPlan& plan, Scratch& scratch) const;
  /// Makes the next ray of a lane whose vertex has all its direct light from samples: emission that the ray
  /// finds counts for all lobes, reflected light only for the narrow ones.
  void follow_direct(Path& path, const PathBlock& block, int lane, bool narrow, std::int32_t vertex,
                     PathBatch& batch, Scratch& scratch) const;
  /// Makes the next ray of a lane, if it has one. `weights` apply from `vertex` on, unless the path only
  /// passes a pane. `lobes`: those that it follows.
  void follow(Path& path, const PathBlock& block, int lane, const DirectionSample& sampled,
              const VertexWeights& weights, std::int32_t vertex, const LightParts::FirstScattering& lobes,
              PathBatch& batch, Scratch& scratch) const;
  /// `background`: of the sky.
  void add_emission(const Path& path, const Emission& emission, bool background, PathBatch& batch) const;
  PathContext context_;
  CachedPathsOptions options_;
  std::optional<Shading> diffuse_shading_;  ///< separates the diffuse lobes, for passes
  const StoredSurfaces& stored_;
  bool separate_delta_;  ///< the light of punctual lights is sampled where paths end in the cache
};

/// Factors by which the light that a path finds next contributes to the vertex that it left: scattering
/// there, and the transmittance of panes and media since.
struct CachedPaths::VertexWeights {
  Color emission{1.0f, 1.0f, 1.0f};   ///< for emission
  Color scattered{1.0f, 1.0f, 1.0f};  ///< for reflected light
  Color cached = Color::Zero();       ///< for H of the vertex (cached_light.h), where it is a record

  void operator*=(const Color& passed) {
    emission *= passed;
    scattered *= passed;
    cached *= passed;
  }
};

struct CachedPaths::Path : PathState {
  VertexWeights weights;
  float spread = 0.0f;          ///< metres: root of the area over which the path has spread
  float first_spread = 0.0f;    ///< square metres: spread of the camera ray at the first surface
  std::int32_t vertex = kNone;  ///< the vertex that the ray left; kNone: the camera
  bool through_medium = false;  ///< a medium has scattered the path since it left `vertex`
  std::int32_t wide_events = 0;
  std::int32_t records = 0;
  bool to_its_end = false;

  Path() = default;
  Path(const World& world, const PathStart& start, std::size_t which)
      : PathState(world, start.sample, which), to_its_end(start.to_its_end) {}
};

/// A light sample of a vertex whose shadow ray has not been traced yet.
struct CachedPaths::Pending {
  std::int32_t vertex = kNone;
  Color direct = Color::Zero();
  Color cached = Color::Zero();
  Color separate = Color::Zero();  ///< of delta lights, by the wide lobes, where it is not cached
  LobeShare lobes;                 ///< that reflect it; only for passes
  bool of_medium = false;          ///< it was scattered by the medium in front of the vertex's next surface
  bool indirect = false;           ///< for passes
  std::uint32_t path = 0;
};

struct CachedPaths::Scratch : Waves<CachedPaths::Path, CachedPaths::Pending> {
  PathBlock diffuse;  ///< a copy of a block whose diffuse lobes are separate
};

}  // namespace gatelight::renderer

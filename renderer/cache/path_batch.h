#pragma once
// Paths that may end in the cache, as chains of vertices. Each vertex has the factor from its light to that
// of the vertex before it. Paths are traced first, then answered in bulk, then summed up from their ends.

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/cache/surface_points.h"
#include "renderer/film/camera_sample.h"
#include "renderer/film/light_parts.h"

namespace gatelight::renderer {

inline constexpr std::int32_t kNone = -1;

/// The light R that a vertex reflects, and its cached part H (cache/cached_light.h). Both are in units of the
/// medium where the path starts (PathState::radiance_scale):
///     R = direct         + reflectance * answer + next.link * R(next)
///     H = cached direct                         + next.cached_link * R(next)
/// `direct` is the light of light samples and the emission that the next ray found. Its cached part is in
/// PathBatch::targets. The size is one cache line.
struct alignas(64) PathVertex {
  std::int32_t previous = kNone;  ///< the vertex whose ray arrived here; kNone: the camera
  std::uint32_t path = 0;
  Color link{1.0f, 1.0f,
             1.0f};  ///< factor from R to R of `previous`: scattering there, panes and media between
  Color cached_link = Color::Zero();  ///< the same for H of `previous`
  Color direct = Color::Zero();
  Color reflectance = Color::Zero();  ///< of the wide lobes, times radiance_scale here
  std::int32_t query = kNone;         ///< into PathBatch::queries
  std::int32_t record = kNone;        ///< into PathBatch::records
};
static_assert(sizeof(PathVertex) == 64);

/// The first wide surface of a path, for the layer of the cache's own radiance (Aov::cache_radiance).
struct PathGuide {
  std::int32_t vertex = kNone;
  std::int32_t query = kNone;  ///< into PathBatch::queries; kNone: the surface has no storage
  Color reflectance = Color::Zero();
  Color separate = Color::Zero();  ///< light samples of the wide lobes that are not cached
};

struct PathBatch {
  PathBatch() = default;
  explicit PathBatch(const PointInputs& inputs) : queries(inputs), records(inputs) {}

  std::vector<Color> emission;       ///< for each path: emission that is visible to the camera
  std::vector<PathVertex> vertices;  ///< each after its predecessor
  SurfacePoints queries;
  SurfacePoints records;
  /// 3 for each record (1 of occlusion): the direct light of H, and after resolve() radiance over
  /// reflectance.
  std::vector<float> targets;
  std::vector<std::int32_t> first_queries;  ///< for each path its first query, or kNone
  std::vector<std::int32_t> first_records;  ///< the same for records
  /// For each path the vertex where its sample of the picture ends, or kNone; empty unless
  /// PathPlan::samples_at.
  std::vector<std::int32_t> ends;
  std::vector<PathGuide> guides;  ///< for each path; empty unless PathPlan::guides
  LightParts parts;               ///< of the samples of the picture, if PathPlan::passes
  /// For each vertex the lobes of the cache's answer there; empty without passes.
  std::vector<LobeShare> answer_lobes;
  std::uint64_t unstored_hits = 0;

  std::size_t paths() const { return emission.size(); }
  /// Clears everything and begins `paths` paths.
  void begin(std::size_t paths);

  Eigen::Map<Color> target(std::int32_t record) {
    return Eigen::Map<Color>(&targets[3 * static_cast<std::size_t>(record)]);
  }

  /// Writes the cache's own radiance to the first hits of the paths: the emission up to the first wide
  /// surface, and the light that this surface reflects by the cache's answer. Call it before resolve().
  void write_guides(std::span<const float> answers, std::span<FirstHit> first_hits) const;

  /// Sums up from the ends. Call it once. answers: 3 floats for each query, radiance over reflectance.
  /// radiance: one for each path, or empty. Completes `targets` and `parts`.
  void resolve(std::span<const float> answers, std::span<Color> radiance);

  /// The number of samples that end in the cache.
  std::size_t count_ends() const;
  /// Copies the points where they end to `points`, from `at` on.
  void copy_ends(SurfacePoints& points, std::size_t at) const;
  /// Ends the samples in the cache: replaces the cached part of the light that the paths have found at `ends`
  /// by the cache's answers, in the order of copy_ends(). Call it after resolve().
  void end_samples(std::span<const float> answers, std::span<Color> radiance);

  /// Merges the first records of each `times` consecutive paths, which begin at the same point, into one with
  /// the mean target. Where a mirror or glass at that point sent the paths to several points, each gets one.
  /// Call it after resolve(); indices in `vertices` and `first_records` are not updated.
  void average_first_records(std::size_t times);

 private:
  /// Adds light of the answer at a path's first vertex to the passes.
  void add_answer(std::size_t vertex, const Color& light);
};

}  // namespace gatelight::renderer

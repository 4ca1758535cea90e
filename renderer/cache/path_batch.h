#pragma once
// Paths that may end in the cache, as chains of vertices. Each vertex has the factor from its light to that
// of the vertex before it. Paths are traced first, then answered in bulk, then summed up from their ends.

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/cache/surface_points.h"
#include "renderer/film/camera_sample.h"

namespace gatelight::renderer {

inline constexpr std::int32_t kNone = -1;

/// The light R that a vertex reflects, and the part H of it that the cache holds (cache/held_light.h). Both
/// are in units of the medium where the path starts (Walker::radiance_scale):
///     R = known      + reflectance * answer + next.link * R(next)
///     H = known held                        + next.held_link * R(next)
/// Known after tracing is the light of light samples and the emission that the next ray found. The known part
/// of H is in PathBatch::targets. The size is one cache line.
struct alignas(64) PathVertex {
  std::int32_t previous = kNone;  ///< the vertex whose ray arrived here; kNone: the camera
  std::uint32_t path = 0;
  Color link{1.0f, 1.0f,
             1.0f};  ///< factor from R to R of `previous`: scattering there, panes and media between
  Color held_link = Color::Zero();  ///< the same for H of `previous`
  Color known = Color::Zero();
  Color reflectance = Color::Zero();  ///< of the wide lobes, times radiance_scale here
  std::int32_t query = kNone;         ///< into PathBatch::queries
  std::int32_t record = kNone;        ///< into PathBatch::records
};
static_assert(sizeof(PathVertex) == 64);

/// Where a path meets a wide surface for the first time, for the picture that the cache alone gives.
struct PathGuide {
  std::int32_t vertex = kNone;
  std::int32_t query = kNone;  ///< into PathBatch::queries; kNone: the surface has no storage
  Color reflectance = Color::Zero();
  Color apart = Color::Zero();  ///< light samples of the wide lobes that the cache does not hold
};

struct PathBatch {
  PathBatch() = default;
  explicit PathBatch(const PointInputs& inputs) : queries(inputs), records(inputs) {}

  std::vector<Color> emission;       ///< for each path: emission that the camera sees
  std::vector<PathVertex> vertices;  ///< each after its predecessor
  SurfacePoints queries;
  SurfacePoints records;
  std::vector<float>
      targets;  ///< 3 for each record (1 of occlusion): what is known of H, then radiance over reflectance
  std::vector<std::int32_t> first_queries;  ///< for each path its first query, or kNone
  std::vector<std::int32_t> first_records;  ///< the same for records
  /// For each path the vertex where its sample of the picture ends, or kNone; empty unless
  /// PathPlan::samples_at.
  std::vector<std::int32_t> ends;
  std::vector<PathGuide> guides;  ///< for each path, or empty where nobody asks (PathPlan::guides)
  std::uint64_t unstored_hits = 0;

  std::size_t paths() const { return emission.size(); }
  /// Clears everything and begins so many paths.
  void begin(std::size_t paths);

  Eigen::Map<Color> target(std::int32_t record) {
    return Eigen::Map<Color>(&targets[3 * static_cast<std::size_t>(record)]);
  }

  /// Tells the first hits of the paths their light as the cache knows it at the first wide surface: emission
  /// up to there, and what that surface reflects, by its answer. Call it before resolve().
  void tell_guides(std::span<const float> answers, std::span<FirstHit> first_hits) const;

  /// Sums up from the ends. Call it once. answers: 3 floats for each query, radiance over reflectance.
  /// radiance: one for each path, or empty. Completes `targets`.
  void resolve(std::span<const float> answers, std::span<Color> radiance);

  /// The number of samples that end in the cache.
  std::size_t count_ends() const;
  /// Copies the points where they end to `points`, from `at` on.
  void copy_ends(SurfacePoints& points, std::size_t at) const;
  /// Ends the samples in the cache: replaces what the cache holds of the light at `ends`, which the paths
  /// have found, by its answers, in the order of copy_ends(). Call it after resolve().
  void end_samples(std::span<const float> answers, std::span<Color> radiance) const;

  /// Merges the first records of each `times` consecutive paths, which begin at the same point, into one with
  /// the mean target. Where a mirror or glass at that point sent the paths to several points, each gets one.
  /// Call it after resolve(); indices in `vertices` and `first_records` are not updated.
  void average_first_records(std::size_t times);
};

}  // namespace gatelight::renderer

#pragma once
// Paths that may end in the cache, as chains of vertices: every vertex knows how its light becomes that of
// the vertex before it. Traced first, answered by the cache in bulk, then summed up from the ends.

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/cache/surface_points.h"
#include "renderer/film/camera_sample.h"

namespace gatelight::renderer {

inline constexpr std::int32_t kNone = -1;

/// The light R that a vertex reflects, and the part H of it that the cache holds (cache/held_light.h), times
/// no albedo, both as they are worth in the medium where the path starts (Walker::radiance_scale):
///     R = known      + reflectance * answer + next.link * R(next)
///     H = known held                        + next.held_link * R(next)
/// Known, as soon as paths are traced, is the light of light samples and of what shines where the path went
/// on. That of H waits in PathBatch::targets. A cache line.
struct alignas(64) PathVertex {
  std::int32_t previous = kNone;  ///< the vertex that looked here; kNone: the camera did
  std::uint32_t path = 0;
  Color link{1.0f, 1.0f, 1.0f};     ///< share of R that becomes R of `previous`: scattering there, panes and
                                    ///< media between
  Color held_link = Color::Zero();  ///< the same for H of `previous`
  Color known = Color::Zero();
  Color reflectance = Color::Zero();  ///< of what the cache holds, times radiance_scale here
  std::int32_t query = kNone;         ///< into PathBatch::queries
  std::int32_t record = kNone;        ///< into PathBatch::records
};
static_assert(sizeof(PathVertex) == 64);

struct PathBatch {
  PathBatch() = default;
  explicit PathBatch(const PointInputs& inputs) : queries(inputs), records(inputs) {}

  std::vector<Color> emission;       ///< for each path what shines where the camera looks
  std::vector<PathVertex> vertices;  ///< each after the one that looked at it
  SurfacePoints queries;
  SurfacePoints records;
  std::vector<float>
      targets;  ///< 3 for each record (1 of occlusion): what is known of H, then radiance over reflectance
  std::vector<std::int32_t> first_queries;  ///< for each path the query nearest to the eye, or kNone
  std::vector<std::int32_t> first_records;  ///< the same for records
  std::uint64_t unstored_hits = 0;

  std::size_t paths() const { return emission.size(); }
  /// Forgets everything, and begins so many paths.
  void begin(std::size_t paths);

  Eigen::Map<Color> target(std::int32_t record) {
    return Eigen::Map<Color>(&targets[3 * static_cast<std::size_t>(record)]);
  }

  /// Sums up from the ends, once. answers: 3 floats for each query, radiance over reflectance. radiance: one
  /// for each path, or empty. Completes `targets`.
  void resolve(std::span<const float> answers, std::span<Color> radiance);

  /// Makes one record of the first records of each `times` paths in a row, which begin at the same point: the
  /// mean target. Where a mirror or glass at that point sent the paths to several, there is one for each.
  /// After resolve(); the indices in `vertices` and `first_records` are those before.
  void average_first_records(std::size_t times);
};

}  // namespace gatelight::renderer

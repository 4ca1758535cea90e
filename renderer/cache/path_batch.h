#pragma once
// Paths that may end in the cache, as trees of light: every vertex knows how the light that arrives at it
// becomes the light that it sends back. Traced first, answered by the cache in bulk, then summed up from the
// ends.

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/cache/surface_points.h"
#include "renderer/camera_sample.h"

namespace gatelight::renderer {

inline constexpr std::int32_t kNone = -1;

/// The light R that a vertex reflects, and the part H of it that the cache holds (cache/held_light.h), times
/// no albedo:
///     R = direct + reflectance * answer + emission_weight * E + scattered_weight * S
///     H = held_direct                   + held_emission_weight * E + held_scattered_weight * S
/// E and S arrive along the direction that the path took.
struct PathVertex {
  std::int32_t previous = kNone;   ///< the vertex that looked here
  Color passed{1.0f, 1.0f, 1.0f};  ///< share of R that reaches `previous`: panes and media between
  Color direct = Color::Zero();
  Color held_direct = Color::Zero();
  Color emission_weight = Color::Zero();
  Color scattered_weight = Color::Zero();
  Color held_emission_weight = Color::Zero();
  Color held_scattered_weight = Color::Zero();
  Color emission = Color::Zero();   ///< E, weighted against light samples
  Color scattered = Color::Zero();  ///< S
  Color reflectance = Color::Zero();
  std::int32_t query = kNone;   ///< into PathBatch::queries
  std::int32_t record = kNone;  ///< into PathBatch::records
};

struct PathBatch {
  PathBatch() = default;
  explicit PathBatch(const PointInputs& inputs) : queries(inputs), records(inputs) {}

  /// The first ones, as many as there are paths, stand for the cameras: R of them is what a path carries.
  std::vector<PathVertex> vertices;
  SurfacePoints queries;
  SurfacePoints records;
  std::vector<float> targets;               ///< 3 for each record, radiance over reflectance
  std::vector<std::int32_t> first_queries;  ///< for each path the query nearest to the eye, or kNone
  std::vector<std::int32_t> first_records;  ///< the same for records
  std::uint64_t unstored_hits = 0;

  /// Sums up from the ends. answers: 3 floats for each query, radiance over reflectance. radiance: one for
  /// each path, or empty. Fills `targets`.
  void resolve(std::span<const float> answers, std::span<Color> radiance);

  /// For each vertex the path that it belongs to.
  std::vector<std::uint32_t> paths_of_vertices() const;

  /// Makes one record of the first records of each `times` paths in a row, which begin at the same point: the
  /// mean target. Where a mirror or glass at that point sent the paths to several, there is one for each.
  /// After resolve(); the indices in `vertices` and `first_records` are those before.
  void average_first_records(std::size_t times);
};

}  // namespace gatelight::renderer

#pragma once
// The points where training paths begin.

#include <optional>
#include <span>
#include <vector>

#include "neural/layout/gate_layout.h"
#include "renderer/cache/cached_paths.h"
#include "renderer/film/camera.h"
#include "renderer/film/film.h"
#include "renderer/film/pixel_filter.h"
#include "renderer/film/sample_order.h"
#include "renderer/sampling/alias_table.h"
#include "renderer/surface/surroundings.h"

namespace gatelight::renderer {

/// The starts of one group of steps, in blocks of neighbours. Block b is starts[offsets[b]] to
/// starts[offsets[b + 1]].
struct TrainingStarts {
  std::vector<PathStart> starts;
  std::vector<Hit> hits;  ///< of the starts' rays; empty where they are not traced yet
  std::vector<std::size_t> offsets;
  std::vector<PixelSample> samples;  ///< of the starts, where they are samples of the picture; else empty

  std::size_t blocks() const { return offsets.size() - 1; }
};

/// Chooses the starts: samples of the picture, points of it that are stratified anew each step, or points on
/// surfaces. Samples of the picture have their own random numbers; those of other points are keyed by (seed,
/// step, start, dimension).
class TrainingPoints {
 public:
  /// World, camera, options and layout must outlive it. sides: the sides of each instance that have storage.
  /// layout: the layout of the features; null for a hash grid.
  TrainingPoints(const World& world, const Camera& camera, const PixelRect& region,
                 const RenderOptions& options, std::span<const neural::Sides> sides,
                 const neural::GateLayout* layout);

  /// Chooses about `count` points, each options.cache.samples_per_point times in a row. need_hits: trace
  /// camera rays now. counts: how often each triangle with storage was trained; empty unless candidates are
  /// compared. first_sample: the points are samples of the picture, from this one on in SampleOrder.
  void choose(std::uint64_t step, std::size_t count, bool need_hits, std::span<const std::uint32_t> counts,
              TrainingStarts& result, RayCounts& rays,
              const std::optional<std::uint64_t>& first_sample = {}) const;

  /// Finds the hits of the starts in a block. `starts.hits` has room for all. Blocks may be traced at the
  /// same time.
  void trace(TrainingStarts& starts, std::size_t block, RayCounts& rays) const;

  static constexpr std::uint32_t kNoTriangle = ~0u;
  /// Index, among all triangles with storage, of the side of the triangle that a ray hit; or kNoTriangle.
  /// Needs a layout.
  std::uint32_t triangle_number(const Hit& hit, const Vec3& direction) const;

 private:
  void from_picture(std::uint64_t step, std::uint64_t first, std::size_t count, TrainingStarts& result) const;
  void from_camera(std::uint64_t step, std::size_t count, TrainingStarts& result) const;
  void from_surfaces(std::uint64_t step, std::size_t count, TrainingStarts& result) const;
  void prefer_seldom(std::uint64_t step, std::span<const std::uint32_t> counts, TrainingStarts& result) const;
  void repeat(std::uint64_t step, TrainingStarts& result) const;
  const World& world_;
  const Camera& camera_;
  PixelRect region_;
  const RenderOptions& options_;
  FilterSampler filter_;
  SampleOrder order_;
  const neural::GateLayout* layout_;
  /// Triangles with storage; by_area_ counts each side.
  struct Triangle {
    std::uint32_t instance;
    std::uint32_t primitive;
    std::uint8_t sides;  ///< neural::Sides
  };
  std::vector<Triangle> triangles_;
  AliasTable by_area_;
  std::optional<Surroundings> surroundings_;  ///< of these triangles
};

}  // namespace gatelight::renderer

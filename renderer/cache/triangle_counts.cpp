#include "renderer/cache/triangle_counts.h"

#include <algorithm>

namespace gatelight::renderer {

TriangleCounts::TriangleCounts(const neural::GateLayout& layout, const TrainingPoints* starts)
    : layout_(&layout), starts_(starts), counts_(layout.triangle_count), counted_at_(layout.triangle_count) {}

void TriangleCounts::add(const RecordBatch& group, std::uint64_t batch, std::uint64_t step) {
  if (counts_.empty()) return;
  const auto count = [&](std::size_t triangle) {
    if (counted_at_[triangle] == step + 1) return;
    counted_at_[triangle] = step + 1;
    if (counts_[triangle] != ~0u) ++counts_[triangle];
  };
  for (std::size_t i = group.batch_split.begin(batch); i < group.batch_split.begin(batch + 1); ++i) {
    const neural::GateSurface& surface = layout_->surfaces[group.records.surface(i)];
    if (surface.triangle_count > 0) count(surface.first_triangle + group.records.triangle(i));
  }
  if (!starts_) return;
  // Paths that begin at a mirror make no record there, so its triangles would always be chosen.
  for (std::size_t i = 0; i < group.starts.hits.size(); ++i) {
    if (!group.starts.hits[i]) continue;
    const Vec3& direction = group.starts.starts[i].sample.camera_ray.ray.direction;
    const std::uint32_t triangle = starts_->triangle_number(group.starts.hits[i], direction);
    if (triangle != TrainingPoints::kNoTriangle) count(triangle);
  }
}

void TriangleCounts::restart(const std::vector<std::uint32_t>& counts) {
  if (counts.size() == counts_.size()) counts_ = counts;
  std::fill(counted_at_.begin(), counted_at_.end(), 0);
}

}  // namespace gatelight::renderer

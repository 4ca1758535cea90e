#include "neural/vulkan/point_upload.h"

#include <cstring>

#include "base/parallel/loops.h"

namespace gatelight::neural::vulkan {

namespace {

constexpr std::uint64_t kAlignment = 16;
/// Points that a task packs.
constexpr std::size_t kPackedPoints = 8192;

std::uint64_t aligned(std::uint64_t bytes) {
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

struct Span {
  const void* data = nullptr;
  std::uint64_t bytes_per_point = 0;
  Address BatchBlock::*address = nullptr;
};

// The spans that the model reads, in upload order.
std::vector<Span> spans_of(const Model& model, const QueryBatch& points, std::span<const float> targets,
                           bool with_targets) {
  const ModelConfig& config = model.config;
  std::vector<Span> spans;
  const auto add = [&](const auto& span, std::uint64_t bytes, Address BatchBlock::*address) {
    spans.push_back({span.data(), bytes, address});
  };
  if (config.encoding == FeatureEncoding::gate) {
    add(points.surfaces, 4, &BatchBlock::surfaces);
    add(points.triangles, 4, &BatchBlock::triangles);
    add(points.barycentrics, 8, &BatchBlock::barycentrics);
  }
  if (uses_input(config, InputSource::position)) add(points.positions, 12, &BatchBlock::positions);
  if (uses_input(config, InputSource::direction)) add(points.directions, 12, &BatchBlock::directions);
  if (uses_input(config, InputSource::normal)) add(points.normals, 12, &BatchBlock::normals);
  if (uses_input(config, InputSource::albedo)) add(points.albedos, 12, &BatchBlock::albedos);
  if (uses_input(config, InputSource::roughness)) add(points.roughnesses, 4, &BatchBlock::roughnesses);
  if (with_targets) add(targets, std::uint64_t{4} * config.mlp.outputs, &BatchBlock::targets);
  return spans;
}

}  // namespace

std::uint64_t upload_bytes(const Model& model, std::uint64_t points, bool targets) {
  std::uint64_t bytes = aligned(sizeof(BatchBlock));
  for (const Span& span : spans_of(model, {}, {}, targets)) bytes += aligned(points * span.bytes_per_point);
  return bytes;
}

void write_upload(const Model& model, const QueryBatch& points, std::span<const float> targets,
                  std::uint64_t begin, Address address, BatchBlock& block, std::byte* to) {
  const std::vector<Span> spans = spans_of(model, points, targets, !targets.empty());
  std::uint64_t at = aligned(sizeof(BatchBlock));
  for (const Span& span : spans) {
    block.*span.address = address + at;
    at += aligned(block.size * span.bytes_per_point);
  }
  for_each_range(block.size, kPackedPoints, [&](std::size_t first, std::size_t end) {
    for (const Span& span : spans) {
      const std::uint64_t each = span.bytes_per_point;
      std::memcpy(to + (block.*span.address - address) + first * each,
                  static_cast<const std::byte*>(span.data) + (begin + first) * each, (end - first) * each);
    }
  });
  std::memcpy(to, &block, sizeof(block));
}

}  // namespace gatelight::neural::vulkan

#include "renderer/cache/surface_points.h"

#include <algorithm>
#include <cmath>

namespace gatelight::renderer {
namespace {

using neural::Float3;

Float3 float3(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

template <typename T>
void copy_range(const std::vector<T>& from, std::size_t begin, std::size_t count, std::vector<T>& to,
                std::size_t at) {
  if (!from.empty())
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(begin), count,
                to.begin() + static_cast<std::ptrdiff_t>(at));
}

}  // namespace

PointInputs::PointInputs(const neural::ModelConfig& config)
    : gate(config.encoding == neural::FeatureEncoding::gate),
      positions(neural::uses_input(config, neural::InputSource::position)),
      directions(neural::uses_input(config, neural::InputSource::direction)),
      normals(neural::uses_input(config, neural::InputSource::normal)),
      albedos(neural::uses_input(config, neural::InputSource::albedo)),
      roughnesses(neural::uses_input(config, neural::InputSource::roughness)) {}

void SurfacePoints::resize(std::size_t size) {
  size_ = size;
  // Surfaces and triangles are kept whatever the encoding: counts and reports read them.
  surfaces_.resize(size);
  triangles_.resize(size);
  barycentrics_.resize(size);
  if (inputs_.positions) positions_.resize(size);
  if (inputs_.directions) directions_.resize(size);
  if (inputs_.normals) normals_.resize(size);
  if (inputs_.albedos) albedos_.resize(size);
  if (inputs_.roughnesses) roughnesses_.resize(size);
}

void SurfacePoints::push_back(const Hit& hit, std::uint32_t side, const Vec3& wo, const Surface& surface,
                              const Color& albedo) {
  ++size_;
  surfaces_.push_back(neural::surface_index(hit.instance, side));
  triangles_.push_back(hit.primitive);
  barycentrics_.push_back({hit.u, hit.v});
  if (inputs_.positions) positions_.push_back(float3(surface.position));
  if (inputs_.directions) directions_.push_back(float3(wo));
  if (inputs_.normals) normals_.push_back(float3(surface.shading_normal));
  if (inputs_.albedos) albedos_.push_back({albedo.x(), albedo.y(), albedo.z()});
  if (inputs_.roughnesses) roughnesses_.push_back(surface.material.roughness);
}

void SurfacePoints::copy(const SurfacePoints& from, std::size_t begin, std::size_t count, std::size_t at) {
  copy_range(from.surfaces_, begin, count, surfaces_, at);
  copy_range(from.triangles_, begin, count, triangles_, at);
  copy_range(from.barycentrics_, begin, count, barycentrics_, at);
  copy_range(from.positions_, begin, count, positions_, at);
  copy_range(from.directions_, begin, count, directions_, at);
  copy_range(from.normals_, begin, count, normals_, at);
  copy_range(from.albedos_, begin, count, albedos_, at);
  copy_range(from.roughnesses_, begin, count, roughnesses_, at);
}

bool SurfacePoints::same_point(std::size_t i, const SurfacePoints& other, std::size_t j) const {
  constexpr float kNear = 1e-4f;
  const neural::Float2& a = barycentrics_[i];
  const neural::Float2& b = other.barycentrics_[j];
  return surfaces_[i] == other.surfaces_[j] && triangles_[i] == other.triangles_[j] &&
         std::abs(a[0] - b[0]) < kNear && std::abs(a[1] - b[1]) < kNear;
}

neural::QueryBatch SurfacePoints::batch(std::size_t begin, std::size_t count) const {
  const auto part = [&]<class T>(const std::vector<T>& values) {
    return values.empty() ? std::span<const T>() : std::span<const T>(values).subspan(begin, count);
  };
  neural::QueryBatch batch;
  batch.surfaces = part(surfaces_);
  batch.triangles = part(triangles_);
  batch.barycentrics = part(barycentrics_);
  batch.positions = part(positions_);
  batch.directions = part(directions_);
  batch.normals = part(normals_);
  batch.albedos = part(albedos_);
  batch.roughnesses = part(roughnesses_);
  batch.size = count;
  return batch;
}

}  // namespace gatelight::renderer

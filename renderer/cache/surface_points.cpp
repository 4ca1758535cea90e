#include "renderer/cache/surface_points.h"

#include <algorithm>
#include <cmath>

namespace gatelight::renderer {
namespace {

using neural::Float3;

Float3 float3(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

PointInputs::PointInputs(const neural::ModelConfig& config)
    : positions(neural::uses_input(config, neural::InputSource::position)),
      directions(neural::uses_input(config, neural::InputSource::direction)),
      normals(neural::uses_input(config, neural::InputSource::normal)),
      albedos(neural::uses_input(config, neural::InputSource::albedo)),
      roughnesses(neural::uses_input(config, neural::InputSource::roughness)) {}

template <class Visit>
void SurfacePoints::each_array(const PointInputs& inputs, Visit visit) {
  using neural::QueryBatch;
  visit(&SurfacePoints::surfaces_, &QueryBatch::surfaces);
  visit(&SurfacePoints::triangles_, &QueryBatch::triangles);
  visit(&SurfacePoints::barycentrics_, &QueryBatch::barycentrics);
  if (inputs.positions) visit(&SurfacePoints::positions_, &QueryBatch::positions);
  if (inputs.directions) visit(&SurfacePoints::directions_, &QueryBatch::directions);
  if (inputs.normals) visit(&SurfacePoints::normals_, &QueryBatch::normals);
  if (inputs.albedos) visit(&SurfacePoints::albedos_, &QueryBatch::albedos);
  if (inputs.roughnesses) visit(&SurfacePoints::roughnesses_, &QueryBatch::roughnesses);
}

void SurfacePoints::resize(std::size_t size) {
  size_ = size;
  each_array(inputs_, [&](auto array, auto) { (this->*array).resize(size); });
}

void SurfacePoints::push_back(const SurfacePoint& p) {
  ++size_;
  surfaces_.push_back(neural::surface_index(p.hit.instance, p.side));
  triangles_.push_back(p.hit.primitive);
  barycentrics_.push_back({p.hit.u, p.hit.v});
  if (inputs_.positions) positions_.push_back(float3(p.position));
  if (inputs_.directions) directions_.push_back(float3(p.wo));
  if (inputs_.normals) normals_.push_back(float3(p.normal));
  if (inputs_.albedos) albedos_.push_back({p.albedo.x(), p.albedo.y(), p.albedo.z()});
  if (inputs_.roughnesses) roughnesses_.push_back(p.roughness);
}

void SurfacePoints::copy(const SurfacePoints& from, std::size_t begin, std::size_t count, std::size_t at) {
  each_array(inputs_, [&](auto array, auto) {
    std::copy_n((from.*array).data() + begin, count, (this->*array).data() + at);
  });
}

void SurfacePoints::pack(Packer& packer) const {
  each_array(inputs_, [&](auto array, auto) { packer.add_all(std::span(this->*array)); });
}

void SurfacePoints::unpack(Unpacker& unpacker, std::size_t size) {
  resize(size);
  each_array(inputs_, [&](auto array, auto) { unpacker.read_all(std::span(this->*array)); });
}

bool SurfacePoints::same_point(std::size_t i, const SurfacePoints& other, std::size_t j) const {
  constexpr float kNear = 1e-4f;
  const neural::Float2& a = barycentrics_[i];
  const neural::Float2& b = other.barycentrics_[j];
  return surfaces_[i] == other.surfaces_[j] && triangles_[i] == other.triangles_[j] &&
         std::abs(a[0] - b[0]) < kNear && std::abs(a[1] - b[1]) < kNear;
}

neural::QueryBatch SurfacePoints::batch(std::size_t begin, std::size_t count) const {
  neural::QueryBatch batch;
  each_array(inputs_,
             [&](auto array, auto view) { batch.*view = std::span(this->*array).subspan(begin, count); });
  batch.size = count;
  return batch;
}

}  // namespace gatelight::renderer

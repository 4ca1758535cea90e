#pragma once
// Points on surfaces in the form of the cache: growing arrays, with a QueryBatch as their view.

#include <cstddef>
#include <vector>

#include "neural/model/batch.h"
#include "neural/model/model.h"
#include "renderer/distributed/packing.h"
#include "renderer/surface/ray.h"
#include "renderer/surface/surface.h"

namespace gatelight::renderer {

/// The inputs that a model reads beside surface, triangle and barycentrics. Others are not stored.
struct PointInputs {
  bool positions = false;
  bool directions = false;
  bool normals = false;
  bool albedos = false;
  bool roughnesses = false;

  PointInputs() = default;
  explicit PointInputs(const neural::ModelConfig& config);
  bool operator==(const PointInputs&) const = default;
};

/// The side of a triangle that a viewer sees, as neural::surface_index takes it.
constexpr std::uint32_t side_of(bool front, bool mirrors) {
  return front != mirrors ? 0u : 1u;
}

/// A point with all inputs that a model may read.
struct SurfacePoint {
  const Hit& hit;
  std::uint32_t side;  ///< 0 or 1
  Vec3 wo;             ///< unit, away from the surface, in world space
  Vec3 position;
  Vec3 normal;  ///< shading normal
  Color albedo;
  float roughness;
};

inline SurfacePoint surface_point(const Hit& hit, std::uint32_t side, const Vec3& wo, const Surface& surface,
                                  const Color& albedo) {
  return {hit, side, wo, surface.position, surface.shading_normal, albedo, surface.material.roughness};
}

class SurfacePoints {
 public:
  SurfacePoints() = default;
  explicit SurfacePoints(const PointInputs& inputs) : inputs_(inputs) {}

  std::size_t size() const { return size_; }
  const PointInputs& inputs() const { return inputs_; }
  void clear() { resize(0); }
  void resize(std::size_t size);

  void push_back(const SurfacePoint& point);

  /// Packs all points.
  void pack(Packer& packer) const;
  /// Replaces all points by `size` unpacked ones.
  void unpack(Unpacker& unpacker, std::size_t size);

  /// Copies `count` points of another with the same inputs: from its `begin` to our `at`. Ranges that do not
  /// overlap may be copied at the same time.
  void copy(const SurfacePoints& from, std::size_t begin, std::size_t count, std::size_t at);

  std::uint32_t surface(std::size_t i) const { return surfaces_[i]; }
  std::uint32_t triangle(std::size_t i) const { return triangles_[i]; }
  const neural::Float2& barycentrics(std::size_t i) const { return barycentrics_[i]; }

  /// Whether point i equals point j of `other`, up to rounding.
  bool same_point(std::size_t i, const SurfacePoints& other, std::size_t j) const;

  /// A view of all points, or of `count` points from `begin` on. Valid until the next change.
  neural::QueryBatch batch() const { return batch(0, size_); }
  neural::QueryBatch batch(std::size_t begin, std::size_t count) const;

 private:
  /// Calls visit(array member, view member) for each stored array. Surfaces, triangles and barycentrics are
  /// stored for every encoding: counts and reports read them.
  template <class Visit>
  static void each_array(const PointInputs& inputs, Visit visit);

  PointInputs inputs_;
  std::size_t size_ = 0;
  std::vector<std::uint32_t> surfaces_;
  std::vector<std::uint32_t> triangles_;
  std::vector<neural::Float2> barycentrics_;
  std::vector<neural::Float3> positions_;
  std::vector<neural::Float3> directions_;
  std::vector<neural::Float3> normals_;
  std::vector<neural::Float3> albedos_;
  std::vector<float> roughnesses_;
};

}  // namespace gatelight::renderer

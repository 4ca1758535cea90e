#pragma once
// The ray tracing kernels of Embree. Only accel.cpp uses Embree; this header has none of its types. Meshes
// that are used once lie in the top level; shared meshes are Embree instances. Instances that move have a top
// level of their own, so that another time costs no more than they do.

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "renderer/surface/coverage.h"
#include "renderer/surface/ray.h"
#include "renderer/surface/ray_masks.h"
#include "scene/scene.h"

namespace gatelight::renderer {

struct AccelOptions {
  int threads = 0;                     ///< of the build; 0 means all of the current arena
  std::string isa = "auto";            ///< auto, scalar (SSE2), avx2 or avx512
  std::size_t memory_limit_bytes = 0;  ///< of Embree's own allocations; 0 means no limit
  bool watertight = true;              ///< no ray slips between triangles that share an edge
  bool spatial_splits = true;          ///< unless it is watertight: a longer build for faster rays

  bool operator==(const AccelOptions&) const = default;
};

/// Rays may be traced by several threads. Holds references to the scene's vertices and to the coverage.
class Accel {
 public:
  /// Throws OutOfMemory, Unavailable (the ISA, or masks), or InputError with Embree's message.
  Accel(const scene::Scene& scene, const Coverage& coverage, const RayMasks& masks,
        const AccelOptions& options);
  ~Accel();
  Accel(const Accel&) = delete;
  Accel& operator=(const Accel&) = delete;

  /// The same scene at another time: builds what moves, and what other rays see. Throws as the constructor
  /// does.
  void update(const scene::Scene& scene, const Coverage& coverage, const RayMasks& masks);

  /// Finds the nearest hits in (0, t_max). The spans have equal sizes. Rays are traced in packets of 16 in
  /// the given order. `coherent` says that neighbours have similar directions.
  void intersect(std::span<const Ray> rays, std::span<Hit> hits, bool coherent) const;

  /// The same for one ray, which is faster than a packet of it.
  Hit intersect(const Ray& ray) const;

  /// The fraction of light that passes along each ray in (0, t_max); zero behind an opaque surface.
  void transmittance(std::span<const Ray> rays, std::span<Color> result) const;

  std::size_t bytes() const;
  const std::string& isa() const { return isa_; }

 private:
  struct State;

  void require_masks(const scene::Scene& scene, const RayMasks& masks) const;
  void check(const scene::Scene& scene) const;

  const Coverage* coverage_;
  std::string isa_;
  std::unique_ptr<State> state_;
};

}  // namespace gatelight::renderer

#pragma once
// Embree, behind one pair of files: no type of it stands here. Single-use meshes lie in the top level; shared
// meshes are Embree instances.

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "renderer/surface/coverage.h"
#include "renderer/surface/ray.h"
#include "scene/scene.h"

namespace gatelight::renderer {

struct AccelOptions {
  int threads = 0;                     ///< of the build; 0: all of the current arena
  std::string isa = "auto";            ///< auto, scalar (SSE2), avx2, avx512
  std::size_t memory_limit_bytes = 0;  ///< of Embree's own allocations; 0: none
};

/// Thread-safe after construction; holds references to the scene's vertices and to the coverage.
class Accel {
 public:
  /// Throws OutOfMemory, Unavailable (the ISA), or std::runtime_error with Embree's own words.
  Accel(const scene::Scene& scene, const Coverage& coverage, const AccelOptions& options);
  ~Accel();
  Accel(const Accel&) = delete;
  Accel& operator=(const Accel&) = delete;

  /// Nearest hits in (0, t_max). Sizes are equal. Rays are traced in packets of 16 in the order given;
  /// `coherent` says that neighbours point the same way.
  void intersect(std::span<const Ray> rays, std::span<Hit> hits, bool coherent) const;

  /// A ray that has passed more panes ends: what is left of it counts as dark.
  static constexpr int kMaxPanes = 64;

  /// Fraction of light that passes along each ray in (0, t_max): zero behind an opaque surface.
  void transmittance(std::span<const Ray> rays, std::span<Color> result) const;

  std::size_t bytes() const;
  const std::string& isa() const { return isa_; }

 private:
  struct State;

  const Coverage& coverage_;
  std::string isa_;
  std::unique_ptr<State> state_;
};

}  // namespace gatelight::renderer

#pragma once
// What a run did: filled by the renderer, written by the application.

#include <cstdint>
#include <string>
#include <vector>

namespace gatelight::renderer {

/// Where a sample was not finite. Enough to draw it again.
struct NonFiniteSample {
  int x = 0;
  int y = 0;
  std::uint32_t sample = 0;
  std::uint32_t seed = 0;
};

struct RayCounts {
  std::uint64_t camera = 0;
  std::uint64_t bounce = 0;
  std::uint64_t shadow = 0;
  double seconds = 0.0;  ///< spent tracing them, summed over threads
};

struct RenderStatistics {
  double build_seconds = 0.0;  ///< acceleration structure, lights, textures
  double render_seconds = 0.0;
  int width = 0;
  int height = 0;
  int spp = 0;                ///< finished for every pixel
  std::uint64_t samples = 0;  ///< camera paths in all
  int threads = 0;
  std::string isa;  ///< that Embree chose
  RayCounts rays;
  std::size_t geometry_bytes = 0;
  std::size_t bvh_bytes = 0;
  std::size_t texture_bytes = 0;
  std::size_t light_bytes = 0;
  std::uint64_t nonfinite = 0;
  std::vector<NonFiniteSample> nonfinite_samples;  ///< the first 16, in the order of (y, x, sample)
  std::uint64_t clamped = 0;
  bool interrupted = false;  ///< stopped before `spp` was reached, by the time limit or by the caller
};

}  // namespace gatelight::renderer

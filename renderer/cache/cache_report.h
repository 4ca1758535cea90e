#pragma once
// Describes the cache that a scene would get. It scouts, but trains nothing.

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/settings/options.h"
#include "renderer/settings/statistics.h"
#include "scene/scene.h"

namespace gatelight::renderer {

class Camera;
struct PixelRect;
struct World;

struct CacheInstanceReport {
  std::string name;
  std::uint64_t triangles = 0;
  std::vector<std::uint32_t> resolutions;  ///< of each level of the stack
  int sides = 0;                           ///< with storage: 0, 1 or 2
  std::uint64_t nodes = 0;                 ///< of all levels and sides
};

struct CacheReport {
  CacheStatistics statistics;  ///< memory, nodes, sides, node spacing, seconds of scouting and setting up
  std::vector<CacheInstanceReport> instances;  ///< in the scene's order; empty for a hash grid
  std::uint64_t bytes_without_scouting = 0;    ///< parameters if all possible sides had storage
};

/// For integrators with a cache. Throws the exceptions of CacheSession.
CacheReport report_cache(const World& world, const Camera& camera, const PixelRect& region,
                         const RenderOptions& options);

}  // namespace gatelight::renderer

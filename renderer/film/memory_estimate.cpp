#include "renderer/film/memory_estimate.h"

#include <fmt/format.h>

#include "renderer/film/film.h"
#include "renderer/image/cryptomatte.h"
#include "renderer/machine/errors.h"
#include "renderer/machine/memory.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {

namespace {

/// Bytes per triangle of Embree's high-quality, robust BVH while it is built. This is a generous estimate,
/// not a measurement. The finished BVH has 64 to 67 (gatelight-bench --benchmark_filter=bvh).
constexpr std::size_t kBvhBytes = 320;
constexpr std::size_t kInstanceBytes = 512;
/// Bytes of an emissive triangle with its node of the light tree and its record for the kernels.
constexpr std::size_t kLightBytes = 336;

}  // namespace

MemoryEstimate estimate_memory(const scene::Scene& scene, const RenderOptions& options) {
  MemoryEstimate need;
  need.geometry = scene::geometry_bytes(scene) + scene::image_bytes(scene);
  for (const scene::Mesh& mesh : scene.meshes) need.bvh += mesh.triangles.size() * kBvhBytes;
  need.bvh += scene.instances.size() * kInstanceBytes;
  for (const scene::Instance& instance : scene.instances) {
    if (scene.material_of(instance).emits())
      need.lights += scene.mesh_of(instance).triangles.size() * kLightBytes;
  }
  for (const scene::Image& image : scene.images) {
    // Four bytes per texel, and a third more for the coarser mip levels.
    need.textures += static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 16 / 3;
  }
  const std::size_t pixels =
      options.region ? static_cast<std::size_t>((*options.region)[2] - (*options.region)[0]) *
                           static_cast<std::size_t>((*options.region)[3] - (*options.region)[1])
                     : static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
  // The sums, and at the same time the resolved picture: 13 floats at most, 21 more for the layers that
  // reconstruction reads, and 38 more for what it reads and writes.
  const std::vector<Aov> aovs = film_aovs(options);
  const bool halves = has(aovs, Aov::reconstruction);
  const std::size_t density =
      options.reconstruct && options.adaptive ? 8 : 0;  // two, and while they are made
  const std::size_t groups = options.light_groups.empty() ? 0 : options.light_groups.size() + 1;
  const std::size_t kept = options.reconstruct ? 72 : halves ? 34 : 13;
  const std::size_t mattes = options.cryptomattes.size() * 2 * kCryptomatteRanks;
  const std::size_t floats = kept + density + (aovs.size() + groups) * 3 + mattes;
  need.film = pixels * (Film::bytes_per_pixel(aovs, groups) + floats * sizeof(float));
  return need;
}

void require_memory(std::string_view what, const RenderOptions& options, std::size_t all, std::size_t more) {
  if (options.memory_limit_bytes > 0 && all > options.memory_limit_bytes) {
    throw OutOfMemory(fmt::format("{} needs about {} MiB, more than --memory-limit {}", what, all >> 20,
                                  options.memory_limit_bytes >> 20));
  }
  const MemoryRoom room = memory_room();
  if (more > room.bytes) {
    throw OutOfMemory(fmt::format("{} needs about {} MiB, and {} leaves {} MiB", what, more >> 20, room.limit,
                                  room.bytes >> 20));
  }
}

}  // namespace gatelight::renderer

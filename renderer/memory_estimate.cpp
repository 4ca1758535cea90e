#include "renderer/memory_estimate.h"

#include "renderer/film.h"

namespace gatelight::renderer {

namespace {

/// Bytes per triangle of Embree's high-quality, robust BVH while it is being built. A generous guess, not a
/// measurement: finished, it holds 64 to 67 (gatelight-bench --benchmark_filter=bvh).
constexpr std::size_t kBvhBytes = 320;
constexpr std::size_t kInstanceBytes = 512;
/// A triangle light with its node of the tree.
constexpr std::size_t kLightBytes = 192;

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
    // Four bytes a texel and a third more for the coarser levels.
    need.textures += static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 16 / 3;
  }
  const std::size_t pixels =
      options.region ? static_cast<std::size_t>((*options.region)[2] - (*options.region)[0]) *
                           static_cast<std::size_t>((*options.region)[3] - (*options.region)[1])
                     : static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
  // The sums, and the resolved picture beside them: at most 13 floats.
  need.film = pixels * (Film::bytes_per_pixel(options.aovs) + 13 * sizeof(float) + options.aovs.size() * 12);
  return need;
}

}  // namespace gatelight::renderer

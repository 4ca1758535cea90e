#include "renderer/film/memory_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/errors.h"
#include "base/platform/memory.h"
#include "renderer/film/film.h"
#include "renderer/image/cryptomatte.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {

namespace {

/// Bytes per triangle of Embree's high-quality, robust BVH while it is built. This is a generous estimate,
/// not a measurement. The finished BVH has 64 to 67 (the benchmark bvh).
constexpr std::size_t kBvhBytes = 320;
constexpr std::size_t kInstanceBytes = 512;
/// Bytes of an emissive triangle with its node of the light tree and its record for the kernels.
constexpr std::size_t kLightBytes = 336;
/// Floats of each pixel of a band that is denoised (denoise.h), and the pixels of a band.
constexpr std::size_t kBandFloats = 18;
constexpr std::size_t kBandPixels = std::size_t{1} << 22;

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
    // Four bytes per texel, eight of a picture of 16 bits, and a third more for the coarser mip levels.
    const std::size_t thirds = image.pixels_16.empty() ? 16 : 32;
    need.textures +=
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * thirds / 3;
  }
  const std::array<int, 4> whole = {0, 0, options.width, options.height};
  const std::array<int, 4> rect = options.region.value_or(whole);
  const auto width = static_cast<std::size_t>(rect[2] - rect[0]);
  const auto height = static_cast<std::size_t>(rect[3] - rect[1]);
  const std::size_t pixels = width * height;
  // The sums, and at the same time the finished picture with its layers, and means and errors of the samples.
  const std::size_t groups = options.light_groups.empty() ? 0 : options.light_groups.size() + 1;
  const FilmContents contents = film_contents(options, std::vector<std::string>(groups));
  const bool denoised = options.denoise.denoiser != DenoiserKind::none;
  const auto edge = static_cast<std::size_t>(denoised ? options.denoise.supersampling : 1);
  const std::size_t sums = pixels * edge * edge;
  const std::size_t layers = options.aovs.size() + groups + (has(options.aovs, Aov::denoising) ? 3 : 0);
  const std::size_t mattes = options.cryptomattes.size() * 2 * kCryptomatteRanks;
  const std::size_t floats = 13 + 3 * layers + mattes;
  need.film = sums * (Film::bytes_per_pixel(contents) + floats * sizeof(float));
  if (denoised) need.film += std::min(sums, kBandPixels) * kBandFloats * sizeof(float) + kDenoiserBytes;
  return need;
}

void require_memory(std::string_view what, const RenderOptions& options, std::size_t all, std::size_t more) {
  if (options.memory_limit_bytes > 0 && all > options.memory_limit_bytes) {
    throw OutOfMemory(fmt::format("{} needs about {} MiB, more than `memory-limit` {}", what, all >> 20,
                                  options.memory_limit_bytes >> 20));
  }
  const MemoryRoom room = memory_room();
  if (more > room.bytes) {
    throw OutOfMemory(fmt::format("{} needs about {} MiB, and {} leaves {} MiB", what, more >> 20, room.limit,
                                  room.bytes >> 20));
  }
}

}  // namespace gatelight::renderer

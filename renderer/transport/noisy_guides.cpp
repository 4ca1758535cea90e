#include "renderer/transport/noisy_guides.h"

#include <algorithm>
#include <vector>

#include "base/parallel/loops.h"
#include "renderer/film/film_samples.h"
#include "renderer/transport/guide_surface.h"

namespace gatelight::renderer {
namespace {

constexpr int kStep = 2;  // pixels between rays

/// Whether one of these rays meets a surface that is seen through, by its material or by its alpha.
bool meets_see_through(const World& world, const std::vector<CameraSample>& samples) {
  std::vector<Ray> rays;
  for (const CameraSample& sample : samples) rays.push_back(sample.ray());
  std::vector<Hit> hits(rays.size());
  world.accel.intersect(rays, hits, true);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit& hit = hits[i];
    if (!hit) continue;
    if (world.scene.material_of(world.scene.instances[hit.instance]).alpha_mode != scene::AlphaMode::opaque)
      return true;
    const RayCone& cone = samples[i].camera_ray.cone;
    const SurfaceInteraction m(world, rays[i], hit, cone.width + cone.spread * hit.t, 0.5f);
    if (is_mirror_or_clear(m.surface.material)) return true;
  }
  return false;
}

}  // namespace

PixelRect noisy_guides(const World& world, const Camera& camera, const PixelRect& region,
                       const RenderOptions& options) {
  if (camera.has_lens() || camera.has_shutter() || world.media.of(scene::kNoVolume).inside != nullptr)
    return region;
  const FilterSampler filter(options.filter, options.filter_width);
  const int columns = (region.width() + kTile - 1) / kTile, rows = (region.height() + kTile - 1) / kTile;
  std::vector<char> found(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
  for_each(found.size(), [&](std::size_t i) {
    const int x0 = region.x0 + static_cast<int>(i) % columns * kTile;
    const int y0 = region.y0 + static_cast<int>(i) / columns * kTile;
    std::vector<CameraSample> samples;
    for (int y = y0; y < std::min(y0 + kTile, region.y1); y += kStep) {
      for (int x = x0; x < std::min(x0 + kTile, region.x1); x += kStep)
        samples.push_back(make_camera_sample({{x, y}, 0}, options, camera, filter));
    }
    found[i] = meets_see_through(world, samples) ? 1 : 0;
  });
  // A tile around them is where the filter of pixels and rays in between may meet the same.
  PixelRect rect{region.x1, region.y1, region.x0, region.y0};
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] == 0) continue;
    const int x = region.x0 + static_cast<int>(i) % columns * kTile;
    const int y = region.y0 + static_cast<int>(i) / columns * kTile;
    rect = {std::min(rect.x0, x - kTile), std::min(rect.y0, y - kTile), std::max(rect.x1, x + 2 * kTile),
            std::max(rect.y1, y + 2 * kTile)};
  }
  if (rect.x0 >= rect.x1) return {region.x0, region.y0, region.x0, region.y0};
  return {std::max(rect.x0, region.x0), std::max(rect.y0, region.y0), std::min(rect.x1, region.x1),
          std::min(rect.y1, region.y1)};
}

}  // namespace gatelight::renderer

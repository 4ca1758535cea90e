#include "renderer/transport/cryptomatte_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/parallel/loops.h"
#include "renderer/film/film_samples.h"
#include "renderer/film/tiles.h"

namespace gatelight::renderer {
namespace {

/// One kind of names. Each instance has one name of the kind.
struct Kind {
  std::vector<std::uint32_t> ids;  ///< by instance
  std::size_t first_layer = 0;
};

std::string name_or_number(const std::string& name, const char* what, std::size_t number) {
  return name.empty() ? fmt::format("{} {}", what, number) : name;
}

std::vector<std::string> names_by_instance(const scene::Scene& scene, MatteKind kind) {
  std::vector<std::string> names;
  names.reserve(scene.instances.size());
  for (const scene::Instance& instance : scene.instances) {
    if (kind == MatteKind::object) {
      names.push_back(name_or_number(instance.name, "node", names.size()));
    } else {
      const auto material = static_cast<std::size_t>(scene.mesh_of(instance).material);
      names.push_back(name_or_number(scene.materials[material].name, "material", material));
    }
  }
  return names;
}

/// Ranks the ids by coverage, the greatest first, then the lower id first. Reorders `ids`, which has one
/// entry for each point that hits a surface.
void rank(std::vector<std::uint32_t>& ids, std::vector<IdCoverage>& ranked) {
  std::sort(ids.begin(), ids.end());
  ranked.clear();
  constexpr float kShare = 1.0f / kCryptomattePoints;  // sums of it are exact
  for (const std::uint32_t id : ids) {
    if (ranked.empty() || ranked.back().id != id) ranked.push_back({id, 0.0f});
    ranked.back().coverage += kShare;
  }
  std::sort(ranked.begin(), ranked.end(), [](const IdCoverage& a, const IdCoverage& b) {
    return a.coverage > b.coverage || (a.coverage == b.coverage && a.id < b.id);
  });
}

}  // namespace

Cryptomattes trace_cryptomattes(const World& world, const Camera& camera, const FilterSampler& filter,
                                const RenderOptions& options, const PixelRect& rect) {
  Cryptomattes mattes;
  std::vector<Kind> kinds;
  for (const MatteKind of : options.cryptomattes) {
    const std::vector<std::string> names = names_by_instance(world.scene, of);
    Kind kind;
    for (const std::string& name : names) kind.ids.push_back(cryptomatte_id(name));
    kind.first_layer = add_kind(mattes, of == MatteKind::object ? "CryptoObject" : "CryptoMaterial", names,
                                rect.index(rect.x0, rect.y1));
    kinds.push_back(std::move(kind));
  }
  if (kinds.empty()) return mattes;
  const TileGrid tiles(rect);
  for_each(static_cast<std::size_t>(tiles.count()), [&](std::size_t tile) {
    std::vector<Pixel> pixels;
    tiles.pixels(static_cast<int>(tile), pixels);
    std::vector<Ray> rays(kCryptomattePoints);
    std::vector<Hit> hits(kCryptomattePoints);
    std::vector<std::uint32_t> ids;
    std::vector<IdCoverage> ranked;
    for (const Pixel& pixel : pixels) {
      // Packets contain the rays of one pixel, so that a part of the picture has the same ones.
      for (std::uint32_t s = 0; s < kCryptomattePoints; ++s)
        rays[s] = make_camera_sample({pixel, s}, options, camera, filter).ray();
      world.accel.intersect(rays, hits, true);
      for (const Kind& kind : kinds) {
        ids.clear();
        for (const Hit& hit : hits) {
          if (hit && !world.catches(hit.instance) && !world.holds_out(hit.instance))
            ids.push_back(kind.ids[hit.instance]);
        }
        rank(ids, ranked);
        set_pixel(mattes, kind.first_layer, rect.index(pixel.x, pixel.y), ranked);
      }
    }
  });
  return mattes;
}

}  // namespace gatelight::renderer

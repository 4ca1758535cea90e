#include "renderer/transport/reference_pass.h"

#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {

ReferencePass::ReferencePass(const World& world, const PassContext& context)
    : context_(context),
      path_(world, path_integrator_options(context.options)),
      ao_(world, resolve_ao_distance(context.options.ao_distance, world.scene.bounds)) {}

void ReferencePass::run(int samples, Film& film, const std::function<void(double)>& report) {
  const TileGrid& tiles = context_.tiles;
  const RenderOptions& options = context_.options;
  each_tile(tiles, report, [&](ReferenceWorker& w, int tile) {
    tiles.pixels(tile, w.pixels);
    for (int sample = 0; sample < samples; ++sample) {
      film.take(w.pixels, w.taken);
      w.results.resize(w.taken.size());
      if (film.needs_first_hits()) w.first_hits.resize(w.taken.size());
      make_camera_samples(w.taken, film, options, context_.camera, context_.filter, w.samples);
      if (options.integrator == Integrator::path) {
        path_.trace(w.samples, w.results, w.first_hits, w.rays, w.path);
      } else {
        ao_.trace(w.samples, w.results, w.first_hits, w.rays, w.ao);
      }
      add_to_film(w.taken, options, w.results, w.first_hits, film, w.counts, w.path.parts.values());
    }
  });
}

}  // namespace gatelight::renderer

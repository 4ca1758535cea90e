#include "renderer/transport/reference_pass.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>

#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {

ReferencePass::ReferencePass(const World& world, const PassContext& context)
    : context_(context),
      path_(world, path_integrator_options(context.options)),
      ao_(world, resolve_ao_distance(context.options.ao_distance, world.scene.bounds)) {}

void ReferencePass::run(int samples, Film& film, const std::function<void(double)>& report) {
  const TileGrid& tiles = context_.tiles;
  const RenderOptions& options = context_.options;
  std::atomic<int> finished{0};
  tbb::parallel_for(
      tbb::blocked_range<int>(0, tiles.count(), 1),
      [&](const tbb::blocked_range<int>& range) {
        ReferenceWorker& w = workers_.local();
        for (int tile = range.begin(); tile < range.end() && !out_of_time(); ++tile) {
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
            add_to_film(w.taken, options, w.results, w.first_hits, film, w.counts, w.path.parts);
          }
          report(static_cast<double>(++finished) / tiles.count());
        }
      },
      tbb::simple_partitioner());
}

}  // namespace gatelight::renderer

#include "renderer/run/finished_picture.h"

#include <algorithm>
#include <utility>

#include "renderer/machine/clock.h"
#include "renderer/reconstruction/reconstruct.h"
#include "renderer/settings/words.h"

namespace gatelight::renderer {
namespace {

/// The layers that reconstruction reads and nobody asked for.
void drop_unwanted(Picture& picture, const std::vector<Aov>& aovs) {
  if (std::find(aovs.begin(), aovs.end(), Aov::reconstruction) != aovs.end()) return;
  std::erase_if(picture.layers, [&](const Layer& layer) {
    return !layer.name.empty() &&
           std::none_of(aovs.begin(), aovs.end(), [&](Aov aov) { return word(aov) == layer.name; });
  });
}

}  // namespace

Picture finished_picture(const Film& film, const RenderOptions& options, tbb::task_arena& arena,
                         double& seconds) {
  Picture picture = film.resolve();
  seconds = 0.0;
  if (!options.reconstruct) return picture;
  const Clock::time_point start = Clock::now();
  SampledPicture samples = sampled_picture(picture);
  drop_unwanted(picture, options.aovs);
  // Occlusion does not depend on what a surface reflects.
  if (options.integrator == Integrator::ao || options.integrator == Integrator::nao)
    std::fill(samples.albedo.begin(), samples.albedo.end(), 1.0f);
  arena.execute([&] {
    Reconstruction finished = reconstruct(samples);
    picture.layers.front().values = std::move(finished.color);
    for (Layer& layer : picture.layers) {
      if (layer.name == word(Aov::error)) layer.values = std::move(finished.error);
    }
  });
  seconds = seconds_since(start);
  return picture;
}

}  // namespace gatelight::renderer

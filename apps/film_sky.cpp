#include "apps/film_sky.h"

namespace gatelight::apps {

void choose_sky_of_film(renderer::Renderer& renderer, const std::vector<int>& frames,
                        const std::function<void(int frame)>& show) {
  if (!renderer.soft_sky()) return;
  renderer.keep_soft_sky({});
  bool sky = true;
  for (const int frame : frames) {
    show(frame);
    sky = renderer.soft_sky().value_or(true);
    if (!sky) break;
  }
  renderer.keep_soft_sky(sky);
}

}  // namespace gatelight::apps

#include "apps/settings/display_defaults.h"

namespace gatelight::apps {

void apply_display_defaults(RenderSettings& settings) {
  using renderer::CachePreset;
  if (!settings.preset) return;
  const renderer::Integrator integrator = settings.render.integrator;
  const bool radiance = integrator == renderer::Integrator::nrc || integrator == renderer::Integrator::path;
  if (radiance && !settings.given.contains("exposure")) settings.exposure.reset();
  const bool finished = settings.preset == CachePreset::preview || settings.preset == CachePreset::standard ||
                        settings.preset == CachePreset::final;
  if (radiance && finished && !settings.given.contains("tonemap"))
    settings.image.display.tonemap = renderer::Tonemap::agx;
}

}  // namespace gatelight::apps

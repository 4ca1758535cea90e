#include "renderer/run/chosen_denoiser.h"

#include <algorithm>
#include <utility>

#include "renderer/machine/errors.h"

namespace gatelight::renderer {

ChosenDenoiser choose_denoiser(const DenoiseOptions& options) {
  if (options.denoiser == DenoiserKind::none) return {};
  try {
    return {&load_oidn(options.library), ""};
  } catch (const MissingDenoiser& error) {
    if (options.denoiser == DenoiserKind::oidn) throw;
    return {nullptr, error.what()};
  }
}

RenderOptions with_denoiser(RenderOptions options, const ChosenDenoiser& chosen) {
  options.denoise.denoiser = chosen.library ? DenoiserKind::oidn : DenoiserKind::none;
  const int factor = options.denoise.supersampling;
  if (!chosen.library || options.spp < factor * factor) options.denoise.supersampling = 1;
  return options;
}

RenderOptions options_of_film(RenderOptions options) {
  const int factor = options.denoise.supersampling;
  if (factor == 1) return options;
  options.width *= factor;
  options.height *= factor;
  if (options.region) {
    for (int& edge : *options.region) edge *= factor;
  }
  if (options.spp < kOpenSpp)
    options.spp = std::max(1, (options.spp + factor * factor - 1) / (factor * factor));
  options.filter = PixelFilter::box;
  options.filter_width = 0.0f;
  return options;
}

}  // namespace gatelight::renderer

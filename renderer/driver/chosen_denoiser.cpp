#include "renderer/driver/chosen_denoiser.h"

#include <algorithm>
#include <utility>

#include "base/errors.h"
#include "renderer/distributed/ranks.h"

namespace gatelight::renderer {
namespace {

ChosenDenoiser load_denoiser(const DenoiseOptions& options) {
  try {
    return {true, &load_oidn(options.library), ""};
  } catch (const MissingDenoiser& error) {
    if (options.denoiser == DenoiserKind::oidn) throw;
    return {false, nullptr, error.what()};
  }
}

}  // namespace

ChosenDenoiser choose_denoiser(const RenderOptions& options) {
  if (options.denoise.denoiser == DenoiserKind::none) return {};
  Ranks& ranks = ranks_or_one(options.ranks);
  ChosenDenoiser chosen;
  if (ranks.first()) chosen = load_denoiser(options.denoise);
  chosen.found = ranks.agreed(chosen.found);
  return chosen;
}

RenderOptions with_denoiser(RenderOptions options, const ChosenDenoiser& chosen) {
  options.denoise.denoiser = chosen.found ? DenoiserKind::oidn : DenoiserKind::none;
  if (!chosen.found || options.spp < options.denoise.film_pixels_per_pixel())
    options.denoise.supersampling = 1;
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
  if (options.spp < kUnlimitedSpp)
    options.spp = std::max(1, options.spp / options.denoise.film_pixels_per_pixel());
  options.filter = PixelFilter::box;
  options.filter_width = 0.0f;
  return options;
}

}  // namespace gatelight::renderer

#include "renderer/settings/resolved_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::renderer {

float resolve_ao_distance(float option, const Box& bounds) {
  if (option >= 0.0f) return option;
  return bounds.isEmpty() ? kInfinity : 0.1f * bounds.diagonal().norm();
}

void check_light_groups(const RenderOptions& options) {
  check_light_groups(options.light_groups);
  if (!options.light_groups.empty() && options.integrator != Integrator::path)
    throw BadOption(
        {"light-groups", "",
         fmt::format("the integrator '{}' does not separate lights", enum_name(options.integrator)),
         "`integrator` path"});
}

bool training_gives_samples(const RenderOptions& options) {
  const CacheOptions& cache = options.cache;
  return options.integrator == Integrator::nrc && cache.view == CacheOutput::final && cache.candidates == 1 &&
         cache.samples_per_point == 1 && cache.path_length == 0;
}

int choose_training_steps(const RenderOptions& options, std::uint64_t pixels) {
  double records = 0x1p21;
  if (options.integrator == Integrator::nrc) {
    const double samples = static_cast<double>(pixels) * options.spp;
    // Paths that are samples of the picture are no loss (cache/README.md).
    const bool gives_samples = options.cache.source == TrainingSource::picture;
    records = gives_samples ? std::clamp(0.6 * samples, 0x1p18, 0x1p25)
                            : std::clamp(1600.0 * std::sqrt(samples), 0x1p19, 0x1p25);
  }
  return static_cast<int>(std::max(1l, std::lround(records / options.cache.batch)));
}

float resolve_filter_width(PixelFilter filter, float option) {
  if (option > 0.0f) return option;
  if (filter == PixelFilter::box) return 1.0f;
  return filter == PixelFilter::tent ? 2.0f : 3.0f;
}

void use_chosen(RenderOptions& options, const ChosenOptions& chosen) {
  if (options.choose_integrator) use_integrator(options, chosen.integrator);
  if (options.watertight == Watertight::automatic) options.watertight = chosen.watertight;
}

void use_integrator(RenderOptions& options, Integrator integrator) {
  options.choose_integrator = false;
  options.integrator = integrator;
  if (integrator == Integrator::path && options.spp_of_paths > 0) options.spp = options.spp_of_paths;
}

void use_device(RenderOptions& options, const CacheStatistics& made) {
  if (made.device.empty()) return;
  options.cache.choose_device = false;
  options.cache.device = made.device;
}

}  // namespace gatelight::renderer

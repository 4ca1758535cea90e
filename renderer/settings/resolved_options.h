#pragma once
// Values of options that depend on others or on the scene.

#include <vector>

#include "base/math.h"
#include "renderer/settings/options.h"
#include "renderer/settings/statistics.h"

namespace gatelight::renderer {

/// Metres: a tenth of the scene's diagonal where the option is negative.
float resolve_ao_distance(float option, const Box& bounds);

/// Throws BadOption for invalid groups of lights, or with an integrator that does not separate lights.
void check_light_groups(const RenderOptions& options);

/// Whether training paths can be samples of the picture: they carry radiance, one path for each point, each
/// to its end.
bool training_gives_samples(const RenderOptions& options);

/// The number of training steps for a picture of this many pixels, where the caller does not choose it.
int choose_training_steps(const RenderOptions& options, std::uint64_t pixels);

/// Full width in pixels: the filter's usual one (box 1, tent 2, Gaussian 3, Blackman-Harris 3) where the
/// option is 0.
float resolve_filter_width(PixelFilter filter, float option);

/// Puts what was chosen in place of RenderOptions::choose_integrator and Watertight::automatic.
void use_chosen(RenderOptions& options, const ChosenOptions& chosen);

/// Sets the integrator that RenderOptions::choose_integrator led to. With path, spp_of_paths replaces spp.
void use_integrator(RenderOptions& options, Integrator integrator);

/// Sets the device that CacheOptions::choose_device led to, if the picture has a cache.
void use_device(RenderOptions& options, const CacheStatistics& made);

}  // namespace gatelight::renderer

#pragma once
// Values of options that depend on others or on the scene.

#include <vector>

#include "renderer/settings/options.h"
#include "scene/math.h"

namespace gatelight::renderer {

/// Metres: a tenth of the scene's diagonal where the option is negative.
float resolve_ao_distance(float option, const scene::Box& bounds);

/// Throws BadOption for groups of lights that are not as they must be, or with an integrator that does not
/// tell lights apart.
void check_light_groups(const RenderOptions& options);

/// Whether training paths can be samples of the picture: of radiance, one for each point, each to its end.
bool training_gives_samples(const RenderOptions& options);

/// The number of training steps for a picture of so many pixels, where the caller does not choose it.
int choose_training_steps(const RenderOptions& options, std::uint64_t pixels);

/// Full width in pixels: the filter's usual one (box 1, tent 2, Gaussian 3, Blackman-Harris 3) where the
/// option is 0.
float resolve_filter_width(PixelFilter filter, float option);

/// Ends RenderOptions::choose_integrator by a choice, with the samples that paths have in its place.
void settle_on(RenderOptions& options, Integrator integrator);

}  // namespace gatelight::renderer

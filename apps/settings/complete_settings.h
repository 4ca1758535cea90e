#pragma once
// Checks that need several flags, and values that follow from them.

#include <cstdint>
#include <set>
#include <string>

#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// Those of the region that is rendered.
std::uint64_t count_pixels(const renderer::RenderOptions& options);

/// Flags that have no effect with the other values: of another encoding, rule or integrator, or of a cache
/// where there is none. They are refused, and left out of recipes.
std::set<std::string> options_without_effect(RenderSettings settings);

/// Checks flags against each other (such as the region against the size) and fills in what follows from them:
/// the view of --eye, the number of threads. Throws BadOption.
void complete_settings(RenderSettings& settings);

/// How presets show their pictures: those of radiance have automatic exposure, and those of finished pictures
/// a curve with room for highlights, where no flag sets them. Call it before complete_settings().
void apply_display_defaults(RenderSettings& settings);

/// Throws BadOption where --frame-groups deals frames that depend on the frame before, with the integrator
/// that was chosen for the scene. complete_settings() checks one that is given.
void check_frame_groups(const FrameSettings& frames, renderer::Integrator integrator);

/// Checks before the long work that inputs exist; a scene without a name is in memory. Throws InputError.
void check_inputs(const RenderSettings& settings);

/// Checks before the long work that outputs can be written. Throws OutputError or UnknownFormat.
void check_outputs(const RenderSettings& settings);

}  // namespace gatelight::apps

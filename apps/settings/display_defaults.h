#pragma once
// How the presets show their pictures.

#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// Presets of radiance have automatic exposure, and those of finished pictures a curve with room for
/// highlights, where no flag sets them. Call it before complete_settings().
void apply_display_defaults(RenderSettings& settings);

}  // namespace gatelight::apps

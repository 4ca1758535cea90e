#pragma once
// Flags of outputs that have no effect on the given outputs.

#include <string>
#include <vector>

#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// A line for each flag that was given and changes none of the outputs, as --exposure of an EXR. Such flags
/// are harmless, so they are reported and not refused.
std::vector<std::string> unused_output_flags(RenderSettings settings);

/// Whether some output is a picture as a screen shows it: PNG, JPEG or TIFF.
bool shows_on_a_screen(const std::vector<std::string>& outputs);

}  // namespace gatelight::apps

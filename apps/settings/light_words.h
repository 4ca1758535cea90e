#pragma once
// The value of --lights.

#include <string>
#include <vector>

#include "scene/light_adjustments.h"

namespace gatelight::apps {

/// Reads "NAME=off;NAME=X;NAME=r,g,b". Throws renderer::BadOption that names the flag, the part and what was
/// expected.
std::vector<scene::LightAdjustment> read_lights(const std::string& flag, const std::string& text);
/// What read_lights() takes.
std::string text_of(const std::vector<scene::LightAdjustment>& lights);

}  // namespace gatelight::apps

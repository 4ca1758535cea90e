#pragma once
// The values of --lights and --ies.

#include <string>
#include <vector>

#include "scene/light_adjustments.h"
#include "scene/light_profiles.h"

namespace gatelight::apps {

/// Reads "NAME=off;NAME=X;NAME=r,g,b". Throws renderer::BadOption that names the flag, the part and what was
/// expected.
std::vector<scene::LightAdjustment> read_lights(const std::string& flag, const std::string& text);
/// What read_lights() takes.
std::string text_of(const std::vector<scene::LightAdjustment>& lights);

/// The same for "NAME=FILE;NAME=FILE".
std::vector<scene::LightProfile> read_profiles(const std::string& flag, const std::string& text);
std::string text_of(const std::vector<scene::LightProfile>& profiles);

}  // namespace gatelight::apps

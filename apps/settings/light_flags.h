#pragma once
// The values of --sky, --lights, --ies and --light-groups.

#include <string>
#include <vector>

#include "renderer/settings/light_group_options.h"
#include "renderer/settings/sky_options.h"
#include "scene/light_adjustments.h"
#include "scene/light_profiles.h"

namespace gatelight::apps {

/// Reads "clear", or "turbidity=3, sun=AZIMUTH,ELEVATION, ground=0.2, size=0.53, intensity=1", with
/// "date=2026-06-21, time=14:30, place=LATITUDE,LONGITUDE, zone=+2" instead of the sun; each part may be left
/// out. Throws BadOption that names the option, the part and what was expected.
renderer::SkyOptions read_sky(const std::string& option, const std::string& text);

/// Reads "NAME=off;NAME=X;NAME=r,g,b". Throws BadOption that names the option, the part and what was
/// expected.
std::vector<scene::LightAdjustment> read_lights(const std::string& option, const std::string& text);
/// Returns the text that read_lights() reads.
std::string text_of(const std::vector<scene::LightAdjustment>& lights);

/// Reads "NAME=FILE;NAME=FILE", with the same exceptions.
std::vector<scene::LightProfile> read_profiles(const std::string& option, const std::string& text);
std::string text_of(const std::vector<scene::LightProfile>& profiles);

/// Reads "NAME=LIGHT,LIGHT;NAME=LIGHT", or "none", with the same exceptions.
std::vector<renderer::LightGroup> read_light_groups(const std::string& option, const std::string& text);

}  // namespace gatelight::apps

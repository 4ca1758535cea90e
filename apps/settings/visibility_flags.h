#pragma once
// The values of --visibility and --light-links.

#include <string>
#include <vector>

#include "scene/light_links.h"
#include "scene/visibility_rules.h"

namespace gatelight::apps {

/// Reads "NAME=RAYS:on|off|only,...;NAME=...". Throws BadOption that names the option, the part and what was
/// expected.
std::vector<scene::VisibilityRule> read_visibility(const std::string& option, const std::string& text);
/// Returns the text that read_visibility() reads.
std::string text_of(const std::vector<scene::VisibilityRule>& rules);

/// Reads "LIGHT=receivers:NODE+NODE,blockers:NODE;LIGHT=...", with the same exceptions.
std::vector<scene::LightLinkRule> read_light_links(const std::string& option, const std::string& text);
std::string text_of(const std::vector<scene::LightLinkRule>& rules);

}  // namespace gatelight::apps

#pragma once
// Flags of `gatelight render` that a window changes while it is open.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// Values by the names of flags, without dashes.
using LiveFlags = std::map<std::string, std::string>;

/// A change of flags: a value, or none for the default.
using FlagChange = std::map<std::string, std::optional<std::string>>;

/// The flags that were given on the command line, as words of a new one: "--spp=64". `settings` are as they
/// were read.
std::vector<std::string> given_words(RenderSettings settings);

/// The flags after a change. Throws BadOption for a flag that a window does not change.
LiveFlags changed(LiveFlags flags, const FlagChange& change);

/// The settings of `gatelight render SCENE` with the words of the command line and, over them, the live
/// flags. Throws BadOption.
RenderSettings settings_of(const std::string& scene, const std::vector<std::string>& words,
                           const LiveFlags& flags);

/// The command that makes the same picture, quoted for a shell.
std::string render_command(const std::string& scene, const std::vector<std::string>& words,
                           const LiveFlags& flags);

}  // namespace gatelight::apps

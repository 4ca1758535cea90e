#pragma once
// What single flags cannot know: whether they go together, and what follows from them.

#include <set>
#include <string>

#include "apps/settings/file_names.h"
#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// Flags that mean nothing beside the other values: of another encoding, rule or integrator, or of a cache
/// where there is none. Refused, and no part of recipes.
std::set<std::string> flags_without_effect(RenderSettings settings);

/// Checks what single flags cannot know (does the region lie in the picture?) and fills in what follows from
/// the flags: the view by hand, the number of threads. Throws UsageError.
void complete_settings(RenderSettings& settings);

/// The files that are read, each with its flag, for those who write further ones.
FileNames read_files(const RenderSettings& settings);

/// Before the long work: the inputs exist, the outputs can be written. Throws InputError,
/// renderer::OutputError or renderer::UnknownFormat.
void check_files(const RenderSettings& settings);

}  // namespace gatelight::apps

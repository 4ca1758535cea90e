#pragma once
// Checks that need several flags, and values that follow from them.

#include <set>
#include <string>

#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// Flags that have no effect with the other values: of another encoding, rule or integrator, or of a cache
/// where there is none. They are refused, and left out of recipes.
std::set<std::string> options_without_effect(RenderSettings settings);

/// Checks flags against each other (such as the region against the size) and fills in what follows from them:
/// the view of --eye, the number of threads. Throws BadOption.
void complete_settings(RenderSettings& settings);

/// Checks before the long work that inputs exist; a scene without a name is in memory. Throws InputError.
void check_inputs(const RenderSettings& settings);

/// Checks before the long work that outputs can be written. Throws OutputError or UnknownFormat.
void check_outputs(const RenderSettings& settings);

}  // namespace gatelight::apps

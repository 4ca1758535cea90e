#pragma once
// --view-file: a view as JSON.

#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// Sets the options of the view that the file names as their flags ("eye": [1, 2, 3], "fov": 40), as far as
/// they are not given by flags. Throws InputError that names the file and the member.
void read_view_file(RenderSettings& settings);

}  // namespace gatelight::apps

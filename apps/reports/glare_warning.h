#pragma once
// A warning of pictures that are far too bright for a screen.

#include <string>

#include "renderer/image/image_write.h"
#include "scene/scene.h"

namespace gatelight::apps {

/// The lights of a file whose numbers are too large for its size, as the value of --lights that divides them
/// by the 683 lm/W of exporters that turn watts into candela or lux. Empty where none is.
std::string lights_from_watts(const scene::Scene& scene);

/// Empty unless more than a third of the pixels is shown as white, and an exposure that suits the picture is
/// far lower.
/// `lights` is lights_from_watts().
std::string glare_warning(const renderer::Picture& picture, const renderer::DisplayOptions& display,
                          float suitable_stops, const std::string& lights);

}  // namespace gatelight::apps

#pragma once
// Warnings of pictures that a screen or a file cannot show as they are.

#include <span>
#include <string>

#include "renderer/image/image_write.h"
#include "scene/scene.h"

namespace gatelight::apps {

/// The lights of a file whose numbers are too large for its size, as the value of --lights that divides them
/// by the 683 lm/W of exporters that turn watts into candela or lux. Empty where none is.
std::string lights_from_watts(const scene::Scene& scene);

/// Empty unless more than a third of the pixels is shown as white, and an exposure that suits the picture is
/// far lower. `lights` is lights_from_watts().
std::string glare_warning(const renderer::Picture& picture, const renderer::DisplayOptions& display,
                          float suitable_stops, const std::string& lights);

/// A warning of values that an EXR of halves cannot hold, counted by layer; empty where there are none, or no
/// such EXR among the outputs.
std::string overflow_warning(const renderer::Picture& picture, std::span<const std::string> outputs,
                             const renderer::ImageWriteOptions& image);

}  // namespace gatelight::apps

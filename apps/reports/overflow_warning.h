#pragma once

#include <span>
#include <string>

#include "renderer/image/image_write.h"

namespace gatelight::apps {

/// A warning of values that an EXR of halves cannot hold, counted by layer; empty where there are none, or no
/// such EXR among the outputs.
std::string overflow_warning(const renderer::Picture& picture, std::span<const std::string> outputs,
                             const renderer::ImageWriteOptions& image);

}  // namespace gatelight::apps

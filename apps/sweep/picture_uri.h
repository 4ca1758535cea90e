#pragma once

#include <string>

#include "renderer/image/display.h"
#include "renderer/image/picture.h"

namespace gatelight::apps {

/// The picture as its PNG would show it, as a JPEG in a data URI. One that is wider than 1280 pixels is made
/// smaller by a whole number, in means of linear light.
std::string picture_uri(const renderer::Picture& picture, const renderer::DisplayOptions& display);

}  // namespace gatelight::apps

#pragma once
// Pictures out of files: EXR with all its layers, Radiance HDR, PNG.

#include <filesystem>
#include <stdexcept>

#include "renderer/image/picture.h"

namespace gatelight::renderer {

/// A picture that cannot be read. The message names the file and the reason.
struct ImageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Linear values: 8 and 16 bit PNG pass through the sRGB curve (alpha does not), EXR and HDR are taken as
/// they are. EXR channels "layer.channel" become layers; those without a layer are the beauty layer, which is
/// first (where there is none, the first layer with R, G and B is). Channels of a layer: R,G,B,A or X,Y,Z
/// first, the others by name. Header strings "gatelight:KEY" become metadata. Throws ImageError, or
/// UnknownFormat for another extension.
Picture read_image(const std::filesystem::path& path);

}  // namespace gatelight::renderer

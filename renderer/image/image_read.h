#pragma once
// Reads pictures from files: EXR with all its layers, Radiance HDR, PNG.

#include <filesystem>

#include "base/errors.h"
#include "renderer/image/picture.h"

namespace gatelight::renderer {

/// Throws UnknownFormat or MissingLibrary if read_image() cannot read a file of this name.
void check_image_input(const std::filesystem::path& path);

/// Reads linear values. PNG files of 8 and 16 bits are decoded with the sRGB curve, except for alpha. EXR and
/// HDR values stay unchanged. EXR channels "layer.channel" become layers. Channels without a layer are the
/// beauty layer, which comes first. If they hold no colours, the first layer with R, G and B comes first
/// instead. The channels of a layer start with R,G,B,A or X,Y,Z; the others follow by name. Header strings
/// "gatelight:KEY" become metadata. Throws InputError, or what check_image_input() throws.
Picture read_image(const std::filesystem::path& path);

}  // namespace gatelight::renderer

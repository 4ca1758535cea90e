#pragma once
// Reads and writes EXR files by OpenEXR, for image_read.h and image_write.h.

#include <filesystem>
#include <string>

#include "renderer/image/picture.h"

namespace gatelight::renderer {

/// The bytes of the file.
std::string encode_exr(const Picture& picture, bool all_float);

/// Throws std::exception; its message does not name the file.
Picture read_exr(const std::filesystem::path& path);

}  // namespace gatelight::renderer

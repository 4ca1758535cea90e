#pragma once
// Reads and writes EXR files by OpenEXR, for image_read.h and image_write.h.

#include <cstdio>
#include <filesystem>

#include "renderer/image/picture.h"

namespace gatelight::renderer {

/// Writes to a seekable stream. Throws std::exception when the stream fails.
void write_exr(const Picture& picture, std::FILE* stream, bool all_float);

/// Throws std::exception; its message does not name the file.
Picture read_exr(const std::filesystem::path& path);

}  // namespace gatelight::renderer

#pragma once
// The OpenEXR side of image_read.h and image_write.h.

#include <cstdio>
#include <filesystem>

#include "renderer/image/picture.h"

namespace gatelight::renderer {

/// Writes to a seekable stream. Throws std::exception when the stream refuses.
void write_exr(const Picture& picture, std::FILE* stream, bool all_float);

/// Throws std::exception without the file's name in front.
Picture read_exr(const std::filesystem::path& path);

}  // namespace gatelight::renderer

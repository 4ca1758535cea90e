#pragma once
// Reads and writes EXR files by OpenEXR, for image_read.h and image_write.h.

#include <cstdio>
#include <filesystem>

#include "renderer/image/picture.h"

namespace gatelight::renderer {

struct EditedExr;

/// Writes to a seekable stream. Throws std::exception when the stream fails.
void write_exr(const Picture& picture, std::FILE* stream, bool all_float);

/// Writes a file again, with some channels as the picture has them, and without the layers that the picture
/// does not have. Channels that a changed layer of the picture has, but not the file, are added to it. All
/// else keeps its bits: channels with their types, parts, windows, attributes. A part that changes becomes
/// one of rows, with ZIP in place of a lossy compression; changed channels keep their type, or are 32-bit
/// floats. Parts whose pixels are incomplete are left out. The picture's metadata is added to the first part.
/// Throws std::exception.
void edit_exr(const Picture& picture, const EditedExr& edited, std::FILE* stream, bool all_float);

/// Throws std::exception; its message does not name the file.
Picture read_exr(const std::filesystem::path& path);

}  // namespace gatelight::renderer

#pragma once
// The file format that a file name asks for.

#include <filesystem>

namespace gatelight::renderer {

enum class ImageFormat { exr, png, jpeg, tiff, hdr, unknown };

/// The extension decides, in upper or lower case.
ImageFormat image_format(const std::filesystem::path& path);

}  // namespace gatelight::renderer

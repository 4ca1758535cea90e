#pragma once
// The file format of a file name.

#include <filesystem>

namespace gatelight::renderer {

enum class ImageFormat { exr, png, jpeg, tiff, hdr, unknown };

/// The extension decides, in upper or lower case.
ImageFormat image_format(const std::filesystem::path& path);

}  // namespace gatelight::renderer

#pragma once
// The file format of a file name.

#include <filesystem>
#include <string_view>

namespace gatelight::renderer {

enum class ImageFormat { exr, png, jpeg, tiff, hdr, unknown };

/// Determined by the extension, in upper or lower case.
ImageFormat image_format(const std::filesystem::path& path);
/// The usual extension of the format, such as ".jpg".
std::string_view extension_of(ImageFormat format);

}  // namespace gatelight::renderer

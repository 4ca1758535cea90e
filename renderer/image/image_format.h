#pragma once
// The file format of a file name.

#include <filesystem>
#include <string_view>

namespace gatelight::renderer {

enum class ImageFormat { exr, png, jpeg, tiff, hdr, unknown };

/// The extension decides, in upper or lower case.
ImageFormat image_format(const std::filesystem::path& path);
/// The usual one: ".jpg".
std::string_view extension_of(ImageFormat format);

}  // namespace gatelight::renderer

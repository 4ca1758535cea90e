#pragma once
// Which format a file name asks for.

#include <filesystem>

namespace gatelight::renderer {

enum class ImageFormat { exr, png, hdr, unknown };

/// By the extension, in any case.
ImageFormat image_format(const std::filesystem::path& path);

}  // namespace gatelight::renderer

#pragma once
// Outputs of pictures: files, or standard output, which is called "-" (PNG) or "FORMAT:-".

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/image/image_format.h"
#include "renderer/image/image_write.h"

namespace gatelight::apps {

/// The format in which a picture goes to standard output; empty where the name is that of a file.
std::optional<renderer::ImageFormat> stdout_format(const std::string& output);

/// The format of a file or of standard output.
renderer::ImageFormat output_format(const std::string& output);

/// Whether the name is that of a picture's file.
bool is_picture(const std::string& file);

/// The outputs that are files.
std::vector<std::string> files_of(std::span<const std::string> outputs);

/// Whether all outputs are files that are there: as each is written whole or not at all, so is the picture.
/// An empty file is no picture.
bool are_there(std::span<const std::string> outputs);

/// Throws BadOption where two results would go to standard output. `stats` may be empty.
void check_stdout(std::span<const std::string> outputs, const std::string& stats = "");

/// Throws UnknownFormat or OutputError where write_picture() cannot write, also to a terminal.
void check_picture_output(const std::string& output);

/// renderer::write_image(), also to standard output: first all is encoded, then written. Throws what that
/// function throws.
void write_picture(const renderer::Picture& picture, const std::string& output,
                   const renderer::ImageWriteOptions& options);

}  // namespace gatelight::apps

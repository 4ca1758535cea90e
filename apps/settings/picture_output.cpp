#include "apps/settings/picture_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <system_error>

#include "apps/terminal/errors.h"
#include "apps/terminal/terminal.h"
#include "base/errors.h"
#include "base/file/atomic_file.h"
#include "renderer/image/image_library.h"

namespace gatelight::apps {

using renderer::ImageFormat;

std::optional<ImageFormat> stdout_format(const std::string& output) {
  constexpr std::string_view kStdout = ":-";
  if (output == "-") return ImageFormat::png;
  if (!output.ends_with(kStdout)) return {};
  const std::string format = output.substr(0, output.size() - kStdout.size());
  if (format.find_first_of("./") != std::string::npos) return {};
  return renderer::image_format("picture." + format);
}

ImageFormat output_format(const std::string& output) {
  return stdout_format(output).value_or(renderer::image_format(output));
}

bool is_picture(const std::string& file) {
  return renderer::image_format(file) != ImageFormat::unknown;
}

std::vector<std::string> files_of(std::span<const std::string> outputs) {
  std::vector<std::string> files;
  std::copy_if(outputs.begin(), outputs.end(), std::back_inserter(files),
               [](const std::string& output) { return !stdout_format(output); });
  return files;
}

bool are_there(std::span<const std::string> outputs) {
  return std::all_of(outputs.begin(), outputs.end(), [](const std::string& output) {
    std::error_code error;
    return !stdout_format(output) && std::filesystem::is_regular_file(output, error) &&
           std::filesystem::file_size(output, error) > 0 && !error;
  });
}

void check_stdout(std::span<const std::string> outputs, const std::string& stats) {
  const std::string* first = nullptr;
  for (const std::string& output : outputs) {
    if (!stdout_format(output)) continue;
    if (first)
      throw BadOption(
          {"output", *first, fmt::format("and '{}' are both standard output", output), "one of them"});
    first = &output;
  }
  if (first && stats == "-")
    throw BadOption(
        {"stats", "-", fmt::format("is standard output, where `output` '{}' writes", *first), "a file"});
}

void check_picture_output(const std::string& output) {
  const std::optional<ImageFormat> format = stdout_format(output);
  if (!format) return renderer::check_image_output(output);
  if (*format == ImageFormat::unknown)
    throw UnknownFormat(
        fmt::format("cannot write '{}': formats of standard output are exr, png, jpg, tif and hdr", output));
  renderer::check_codec(*format);
  if (::fcntl(STDOUT_FILENO, F_GETFD) < 0)
    throw OutputError(fmt::format("cannot write '{}': standard output is closed", output));
  if (::isatty(STDOUT_FILENO) != 0)
    throw OutputError(
        fmt::format("cannot write '{}': standard output is a terminal, expected a pipe or a file", output));
}

void write_picture(const renderer::Picture& picture, const std::string& output,
                   const renderer::ImageWriteOptions& options) {
  const std::optional<ImageFormat> format = stdout_format(output);
  if (!format) return renderer::write_image(picture, output, options);
  const std::vector<std::uint8_t> bytes = renderer::encode_image(picture, *format, options);
  write_stdout({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace gatelight::apps

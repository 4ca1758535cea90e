#pragma once
// Checks the size that a picture's header claims, before memory is allocated for it.

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>

namespace gatelight {

/// Throws std::runtime_error for a size that is too large, or that a file of this many bytes cannot fill. One
/// bit of a PNG becomes four bytes of float, which deflate compresses 33 000 times. EXR's DWAB compresses a
/// black picture 24 000 times.
inline void check_claimed_size(std::int64_t width, std::int64_t height, std::int64_t channels,
                               const std::filesystem::path& path) {
  // The largest side of our own pictures. For a wider one OpenImageIO holds 256 rows at once, even if there
  // are fewer.
  constexpr std::int64_t kMaxSide = 1 << 16;
  constexpr std::int64_t kMaxValues = std::int64_t{1} << 31;
  constexpr std::int64_t kSmallValues = std::int64_t{1} << 24;
  constexpr std::int64_t kMaxPerByte = 1 << 14;  ///< values per byte of the file
  if (width < 1 || height < 1 || channels < 1) throw std::runtime_error("it has no pixels");
  const bool fits = width <= kMaxSide && height <= kMaxSide && channels <= kMaxSide;
  if (!fits || width * height > kMaxValues / channels) {
    throw std::runtime_error(
        fmt::format("its {} x {} pixels of {} channels are too many", width, height, channels));
  }
  std::error_code error;
  const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(path, error));
  const std::int64_t values = width * height * channels;
  if (error || (values > kSmallValues && values / kMaxPerByte > bytes)) {
    throw std::runtime_error(
        fmt::format("its {} x {} pixels of {} channels are too many for a file of {} bytes", width, height,
                    channels, bytes));
  }
}

}  // namespace gatelight

#pragma once
// Decodes WebP files with libwebp.

#include <cstdint>
#include <vector>

namespace gatelight {

/// Reads lossy and lossless pictures. The values are those of the file: no colour profile, no multiplication
/// by alpha.
class WebpReader {
 public:
  /// Reads the header. Throws std::runtime_error with a one-line message for damaged data and for animations.
  explicit WebpReader(std::vector<std::uint8_t> file);

  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channels_; }  ///< 3 or 4

  /// Returns width * height * channels values, rows from the top. Throws std::runtime_error where pixels are
  /// missing or damaged.
  std::vector<std::uint8_t> read_8() const;

 private:
  std::vector<std::uint8_t> file_;
  int width_ = 0;
  int height_ = 0;
  int channels_ = 0;
};

}  // namespace gatelight

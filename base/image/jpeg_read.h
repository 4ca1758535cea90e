#pragma once
// Decodes JPEG files with libjpeg, without its messages on stderr.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace gatelight {

/// Reads grey, YCbCr, RGB, CMYK and YCCK. The values are those of the file: no colour profile, no
/// orientation.
class JpegReader {
 public:
  /// Reads the header. Throws std::runtime_error with a one-line message for damaged data.
  explicit JpegReader(std::vector<std::uint8_t> file);
  ~JpegReader();
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channels_; }  ///< 1 or 3

  /// Returns width * height * channels values, rows from the top. Call it once. Throws std::runtime_error
  /// where pixels are missing or damaged.
  std::vector<std::uint8_t> read_8();
  /// libjpeg's warning about damage that affects no pixel; empty if there is none. Valid after read_8().
  const std::string& warning() const { return warning_; }

 private:
  struct Decoder;

  std::vector<std::uint8_t> file_;
  std::unique_ptr<Decoder> decoder_;
  std::string warning_;
  int width_ = 0;
  int height_ = 0;
  int channels_ = 0;
};

}  // namespace gatelight

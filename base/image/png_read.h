#pragma once
// Decodes PNG files with libpng, without its messages on stderr.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

namespace gatelight {

/// Reads grey, grey-alpha, RGB and RGBA. Palettes, fewer than 8 bits and transparent colours are expanded.
/// The values are those of the file: no gamma, no colour profile, no multiplication by alpha.
class PngReader {
 public:
  /// Reads the header. Throws std::runtime_error with a one-line message for damaged data.
  explicit PngReader(std::vector<std::uint8_t> file);
  ~PngReader();
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channels_; }  ///< 1 to 4
  int bits() const { return bits_; }          ///< of a channel in the file: 8 for fewer, or 16

  /// Returns width * height * channels values, rows from the top; 16 bits are rounded to 8. Call either
  /// read_8() or read_16(), once. Throws std::runtime_error for damaged data, also behind the pixels.
  std::vector<std::uint8_t> read_8();
  /// The same with 16 bits; 8 bits are scaled, so that 255 becomes 65535.
  std::vector<std::uint16_t> read_16();

 private:
  struct Decoder;

  template <typename Value>
  std::vector<Value> read();

  std::vector<std::uint8_t> file_;
  std::unique_ptr<Decoder> decoder_;
  int width_ = 0;
  int height_ = 0;
  int channels_ = 0;
  int bits_ = 8;
};

/// Opens a PNG file. Throws std::runtime_error, also when the file cannot be read.
PngReader open_png(const std::filesystem::path& path);

}  // namespace gatelight

#pragma once
// Decodes PNG files by libpng, which is kept from printing what it dislikes.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

namespace gatelight::scene {

/// Grey, grey and alpha, RGB or RGBA; palettes, fewer bits than 8 and transparent colours are resolved.
/// Values are those of the file: neither gamma nor profile is applied, nor is a colour multiplied by its
/// alpha.
class PngReader {
 public:
  /// Checks all chunks and reads the header. Throws std::runtime_error with one line for damaged data; `file`
  /// is copied as far as it is needed.
  explicit PngReader(std::span<const std::uint8_t> file);
  ~PngReader();
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channels_; }  ///< 1 to 4

  /// Rows from the top, width * height * channels values; each may be called once, and only one of them.
  /// Files of 16 bits are rounded to 8. Throws std::runtime_error.
  std::vector<std::uint8_t> read_8();
  /// Files of 8 bits are scaled: 255 becomes 65535.
  std::vector<std::uint16_t> read_16();

 private:
  struct Decoder;

  std::size_t row_values() const;
  void read_rows(std::uint8_t* pixels, int bits);

  std::vector<std::uint8_t> file_;
  std::unique_ptr<Decoder> decoder_;
  int width_ = 0;
  int height_ = 0;
  int channels_ = 0;
};

/// Of a file. Throws std::runtime_error where it cannot be read, too.
PngReader open_png(const std::filesystem::path& path);

}  // namespace gatelight::scene

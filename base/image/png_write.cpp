#include "base/image/png_write.h"

#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstddef>
#include <cstring>
#include <new>
#include <stdexcept>
#include <utility>

namespace gatelight {
namespace {

/// Rendered pictures contain noise, which row filters and higher levels hardly compress.
constexpr int kCompressionLevel = 3;

// libpng leaves a failed call by longjmp, so write() holds no objects with a destructor.
struct PngEncoder {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::vector<std::uint8_t> file;
  bool out_of_memory = false;
  char message[256] = "";

  PngEncoder() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, on_error, [](png_structp, png_const_charp) {});
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) {
      png_destroy_write_struct(&png, nullptr);
      throw std::bad_alloc();
    }
  }
  ~PngEncoder() { png_destroy_write_struct(&png, &info); }
  PngEncoder(const PngEncoder&) = delete;
  PngEncoder& operator=(const PngEncoder&) = delete;

  [[noreturn]] static void on_error(png_structp png, png_const_charp message) {
    auto* self = static_cast<PngEncoder*>(png_get_error_ptr(png));
    std::strncpy(self->message, message, sizeof self->message - 1);
    png_longjmp(png, 1);
  }

  /// An exception must not pass through libpng.
  bool append(const std::uint8_t* bytes, std::size_t count) noexcept try {
    file.insert(file.end(), bytes, bytes + count);
    return true;
  } catch (const std::bad_alloc&) {
    out_of_memory = true;
    return false;
  }

  static void on_write(png_structp png, png_bytep bytes, std::size_t count) {
    auto* self = static_cast<PngEncoder*>(png_get_io_ptr(png));
    if (!self->append(bytes, count)) png_error(png, "out of memory");
  }

  bool write(const std::uint8_t* pixels, int width, int height, int channels, int bits) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_write_fn(png, this, on_write, nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits,
                 channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_NO_FILTERS);
    png_set_compression_level(png, kCompressionLevel);
    png_write_info(png, info);
    if (bits == 16 && std::endian::native == std::endian::little) png_set_swap(png);
    const std::size_t row = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels * bits / 8);
    for (int y = 0; y < height; ++y) png_write_row(png, pixels + static_cast<std::size_t>(y) * row);
    png_write_end(png, info);
    return true;
  }
};

std::vector<std::uint8_t> encode(std::span<const std::byte> pixels, int width, int height, int channels,
                                 int bits) {
  PngEncoder encoder;
  if (!encoder.write(reinterpret_cast<const std::uint8_t*>(pixels.data()), width, height, channels, bits)) {
    if (encoder.out_of_memory) throw std::bad_alloc();
    throw std::runtime_error(encoder.message);
  }
  return std::move(encoder.file);
}

}  // namespace

std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> pixels, int width, int height,
                                     int channels) {
  return encode(std::as_bytes(pixels), width, height, channels, 8);
}

std::vector<std::uint8_t> encode_png(std::span<const std::uint16_t> pixels, int width, int height,
                                     int channels) {
  return encode(std::as_bytes(pixels), width, height, channels, 16);
}

}  // namespace gatelight

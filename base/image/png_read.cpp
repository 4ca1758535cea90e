#include "base/image/png_read.h"

#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstring>
#include <fstream>
#include <new>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace gatelight {

// libpng leaves a failed call by longjmp, so the functions that call it hold no objects with a destructor.
struct PngReader::Decoder {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::span<const std::uint8_t> rest;
  char message[256] = "";

  Decoder() {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) {
      png_destroy_read_struct(&png, nullptr, nullptr);
      throw std::bad_alloc();
    }
  }
  ~Decoder() { png_destroy_read_struct(&png, &info, nullptr); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  [[noreturn]] static void on_error(png_structp png, png_const_charp message) {
    auto* self = static_cast<Decoder*>(png_get_error_ptr(png));
    std::strncpy(self->message, message, sizeof self->message - 1);
    png_longjmp(png, 1);
  }

  /// A transparency with a wrong checksum is the only damage to the pixels of which libpng merely warns.
  static void on_warning(png_structp png, png_const_charp message) {
    if (std::string_view(message) == "tRNS: CRC error") on_error(png, message);
  }

  static void on_read(png_structp png, png_bytep target, std::size_t count) {
    auto* self = static_cast<Decoder*>(png_get_io_ptr(png));
    if (count > self->rest.size()) png_error(png, "the data ends early");
    std::memcpy(target, self->rest.data(), count);
    self->rest = self->rest.subspan(count);
  }

  bool read_header() {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_read_fn(png, this, on_read);
    // The caller decides which sizes are too large.
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    // Skips every chunk that does not define pixels: glTF ignores colour profiles and gamma.
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_read_info(png, info);
    // Expands palettes to RGB, transparent colours to alpha, and fewer bits to 8.
    png_set_expand(png);
    return true;
  }

  /// `bits` is 8 or 16.
  bool read_rows(std::uint8_t* pixels, std::size_t row_bytes, int height, int bits) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    if (bits == 8) png_set_scale_16(png);
    if (bits == 16) png_set_expand_16(png);
    if (bits == 16 && std::endian::native == std::endian::little) png_set_swap(png);
    const int passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    if (png_get_rowbytes(png, info) != row_bytes) png_error(png, "rows of an unexpected size");
    for (int pass = 0; pass < passes; ++pass) {
      for (int y = 0; y < height; ++y) {
        png_read_row(png, pixels + static_cast<std::size_t>(y) * row_bytes, nullptr);
      }
    }
    png_read_end(png, nullptr);
    return true;
  }
};

namespace {

int channels_of(int color_type, bool transparent_color) {
  const bool color = (color_type & PNG_COLOR_MASK_COLOR) != 0;
  const bool alpha = (color_type & PNG_COLOR_MASK_ALPHA) != 0 || transparent_color;
  return (color ? 3 : 1) + (alpha ? 1 : 0);
}

}  // namespace

PngReader::PngReader(std::vector<std::uint8_t> file)
    : file_(std::move(file)), decoder_(std::make_unique<Decoder>()) {
  decoder_->rest = file_;
  if (!decoder_->read_header()) throw std::runtime_error(decoder_->message);
  const png_const_structp png = decoder_->png;
  const png_const_infop info = decoder_->info;
  width_ = static_cast<int>(png_get_image_width(png, info));
  height_ = static_cast<int>(png_get_image_height(png, info));
  bits_ = png_get_bit_depth(png, info) == 16 ? 16 : 8;
  channels_ = channels_of(png_get_color_type(png, info), png_get_valid(png, info, PNG_INFO_tRNS) != 0);
}

PngReader::~PngReader() = default;

template <typename Value>
std::vector<Value> PngReader::read() {
  const std::size_t row = static_cast<std::size_t>(width_) * static_cast<std::size_t>(channels_);
  std::vector<Value> pixels(row * static_cast<std::size_t>(height_));
  auto* bytes = reinterpret_cast<std::uint8_t*>(pixels.data());
  if (!decoder_->read_rows(bytes, row * sizeof(Value), height_, 8 * static_cast<int>(sizeof(Value)))) {
    throw std::runtime_error(decoder_->message);
  }
  return pixels;
}

std::vector<std::uint8_t> PngReader::read_8() {
  return read<std::uint8_t>();
}

std::vector<std::uint16_t> PngReader::read_16() {
  return read<std::uint16_t>();
}

PngReader open_png(const std::filesystem::path& path) {
  std::vector<std::uint8_t> bytes(std::filesystem::file_size(path));
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) {
    throw std::runtime_error("its bytes cannot be read");
  }
  return PngReader(std::move(bytes));
}

}  // namespace gatelight

#include "base/image/jpeg_read.h"

#include <cstddef>
#include <cstdio>  // before jpeglib.h, which needs FILE

#include <jpeglib.h>
// After jpeglib.h.
#include <jerror.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace gatelight {
namespace {

/// A progressive file of some kilobytes may hold thousands of scans, each of which visits all pixels.
constexpr int kMaxScans = 500;

/// CMYK as JPEG files hold it, with 255 for no ink, to RGB.
void to_rgb(const std::uint8_t* cmyk, std::size_t pixels, std::uint8_t* rgb) {
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      rgb[3 * i + c] = static_cast<std::uint8_t>((cmyk[4 * i + c] * cmyk[4 * i + 3] + 127) / 255);
  }
}

}  // namespace

// libjpeg leaves a failed call by longjmp, so the functions that call it hold no objects with a destructor.
struct JpegReader::Decoder {
  jpeg_decompress_struct info{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf failed{};
  char damage[JMSG_LENGTH_MAX] = "";    ///< the first message about pixels
  char harmless[JMSG_LENGTH_MAX] = "";  ///< the first other message

  Decoder() {
    info.err = jpeg_std_error(&errors);
    info.client_data = this;
    errors.error_exit = on_error;
    errors.emit_message = on_message;
    errors.output_message = [](j_common_ptr) {};
    progress.progress_monitor = on_progress;
  }
  ~Decoder() { jpeg_destroy_decompress(&info); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  static Decoder& self(j_common_ptr common) { return *static_cast<Decoder*>(common->client_data); }

  [[noreturn]] static void on_error(j_common_ptr common) {
    common->err->format_message(common, self(common).damage);
    std::longjmp(self(common).failed, 1);
  }

  /// Level -1 is a warning: libjpeg fills in the missing data and continues.
  static void on_message(j_common_ptr common, int level) {
    if (level >= 0) return;
    const bool between_segments = common->err->msg_code == JWRN_EXTRANEOUS_DATA;
    char* const text = between_segments ? self(common).harmless : self(common).damage;
    if (text[0] == '\0') common->err->format_message(common, text);
  }

  static void on_progress(j_common_ptr common) {
    Decoder& decoder = self(common);
    if (decoder.info.input_scan_number <= kMaxScans) return;
    std::strncpy(decoder.damage, "too many scans", sizeof decoder.damage - 1);
    std::longjmp(decoder.failed, 1);
  }

  bool read_header(const std::uint8_t* data, std::size_t size) {
    if (setjmp(failed) != 0) return false;
    jpeg_create_decompress(&info);
    info.progress = &progress;
    jpeg_mem_src(&info, data, size);
    jpeg_read_header(&info, TRUE);
    if (info.num_components == 4) {
      info.out_color_space = JCS_CMYK;
    } else if (info.jpeg_color_space != JCS_GRAYSCALE && info.num_components == 3) {
      info.out_color_space = JCS_RGB;
    } else if (info.num_components != 1) {
      std::snprintf(damage, sizeof damage, "%d components", info.num_components);
      return false;
    }
    return true;
  }

  /// `line` holds a row of CMYK; null: rows go directly to `pixels`.
  bool read_rows(std::uint8_t* pixels, std::size_t row_bytes, std::uint8_t* line) {
    if (setjmp(failed) != 0) return false;
    jpeg_start_decompress(&info);
    while (info.output_scanline < info.output_height) {
      std::uint8_t* const row = pixels + info.output_scanline * row_bytes;
      JSAMPROW target = line != nullptr ? line : row;
      jpeg_read_scanlines(&info, &target, 1);
      if (line != nullptr) to_rgb(line, info.output_width, row);
    }
    return damage[0] == '\0';
  }
};

JpegReader::JpegReader(std::vector<std::uint8_t> file)
    : file_(std::move(file)), decoder_(std::make_unique<Decoder>()) {
  if (!decoder_->read_header(file_.data(), file_.size())) throw std::runtime_error(decoder_->damage);
  width_ = static_cast<int>(decoder_->info.image_width);
  height_ = static_cast<int>(decoder_->info.image_height);
  channels_ = decoder_->info.num_components == 1 ? 1 : 3;
}

JpegReader::~JpegReader() = default;

std::vector<std::uint8_t> JpegReader::read_8() {
  const auto width = static_cast<std::size_t>(width_);
  const std::size_t row = width * static_cast<std::size_t>(channels_);
  std::vector<std::uint8_t> pixels(row * static_cast<std::size_t>(height_));
  std::vector<std::uint8_t> line(decoder_->info.num_components == 4 ? 4 * width : 0);
  if (!decoder_->read_rows(pixels.data(), row, line.empty() ? nullptr : line.data()))
    throw std::runtime_error(decoder_->damage);
  warning_ = decoder_->harmless;
  return pixels;
}

}  // namespace gatelight

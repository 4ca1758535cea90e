#pragma once
// The functions that use OpenImageIO. It brings 260 shared libraries, so they are in a library of our own
// that is loaded when it is first needed.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "renderer/image/image_format.h"
#include "renderer/image/ocio_view.h"
#include "renderer/image/picture.h"

namespace gatelight::renderer {

class ImageLibrary {
 public:
  /// Reads a Radiance picture as linear RGB. Throws std::runtime_error.
  virtual Picture read_hdr(const std::filesystem::path& path) const = 0;
  /// Resizes a picture of three channels with a triangle filter, on the calling thread. Throws
  /// std::runtime_error.
  virtual std::vector<float> resize(const std::vector<float>& rgb, int width, int height, int to_width,
                                    int to_height) const = 0;
  /// A file in memory, of 3 or 4 values a pixel, rows from the top. TIFF: display values in [0, 1] with
  /// straight alpha, in 8 or 16 bits. HDR: radiance, three channels. Throws std::runtime_error.
  virtual std::vector<std::uint8_t> encode(ImageFormat format, const std::vector<float>& values, int width,
                                           int height, int bits) const = 0;
  /// Replaces linear colours of Rec. 709, three values each, by the code values of a view. Throws BadOption.
  virtual void show(std::vector<float>& rgb, const OcioView& ocio) const = 0;

 protected:
  ~ImageLibrary() = default;
};

/// Loads the library at the first call. Thread-safe. Throws MissingLibrary.
const ImageLibrary& image_library();

/// Throws MissingLibrary if OpenImageIO reads or writes files of this format and cannot be loaded.
void check_codec(ImageFormat format);

}  // namespace gatelight::renderer

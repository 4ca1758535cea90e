#include "apps/sweep/picture_uri.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include "renderer/image/srgb.h"

namespace gatelight::apps {
namespace {

struct Pixels {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> bytes;  ///< RGB, sRGB
};

float decode(std::uint8_t byte, PictureKind kind) {
  return kind == PictureKind::map ? static_cast<float>(byte) / 255.0f : renderer::kSrgbToLinear[byte];
}

std::uint8_t encode(float value, PictureKind kind) {
  if (kind == PictureKind::light) return renderer::display_byte(value, 1.0f, renderer::Tonemap::none);
  return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

Pixels shrink(const Pixels& pixels, PictureKind kind, int width) {
  const int height =
      std::max(1, static_cast<int>(std::lround(static_cast<double>(pixels.height) * width / pixels.width)));
  std::vector<float> values(pixels.bytes.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = decode(pixels.bytes[i], kind);
  const OIIO::ImageBuf source(OIIO::ImageSpec(pixels.width, pixels.height, 3, OIIO::TypeDesc::FLOAT),
                              values.data());
  OIIO::ImageBuf target(OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::FLOAT));
  // On one thread, because several pictures are made at once.
  if (!OIIO::ImageBufAlgo::resize(target, source, "triangle", 0.0f, {}, 1))
    throw std::runtime_error(target.geterror());
  values.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  target.get_pixels(target.roi(), OIIO::TypeDesc::FLOAT, values.data());
  Pixels smaller{.width = width, .height = height};
  smaller.bytes.reserve(values.size());
  for (const float x : values) smaller.bytes.push_back(encode(x, kind));
  return smaller;
}

std::vector<unsigned char> encode_jpeg(const Pixels& pixels, PictureKind kind) {
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("jpeg");
  if (!output) throw std::runtime_error("cannot make a JPEG: " + OIIO::geterror());
  OIIO::ImageSpec spec(pixels.width, pixels.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("Compression", kind == PictureKind::map ? "jpeg:75" : "jpeg:88");
  // Noise is coloured, so subsampled colour would change what is compared.
  spec.attribute("jpeg:subsampling", kind == PictureKind::map ? "4:2:0" : "4:4:4");
  std::vector<unsigned char> encoded;
  OIIO::Filesystem::IOVecOutput memory(encoded);
  if (!output->set_ioproxy(&memory) || !output->open("memory.jpg", spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, pixels.bytes.data()) || !output->close()) {
    throw std::runtime_error("cannot make a JPEG: " + output->geterror());
  }
  return encoded;
}

}  // namespace

EmbeddedPicture embed_picture(const renderer::Picture& picture, const renderer::ImageWriteOptions& display,
                              PictureKind kind, int max_width) {
  Pixels pixels{picture.width, picture.height, renderer::display_bytes(picture, display)};
  if (pixels.width > max_width) pixels = shrink(pixels, kind, max_width);
  const std::vector<unsigned char> jpeg = encode_jpeg(pixels, kind);
  return {.size = {picture.width, picture.height},
          .width = pixels.width,
          .uri = "data:image/jpeg;base64," +
                 OIIO::Strutil::base64_encode({reinterpret_cast<const char*>(jpeg.data()), jpeg.size()})};
}

}  // namespace gatelight::apps

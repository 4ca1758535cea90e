#include "apps/sweep/picture_uri.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "renderer/srgb.h"

namespace gatelight::apps {
namespace {

struct Pixels {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> bytes;  ///< RGB, sRGB
};

Pixels shrink(const Pixels& pixels, int width) {
  const int height =
      std::max(1, static_cast<int>(std::lround(static_cast<double>(pixels.height) * width / pixels.width)));
  std::vector<float> light(pixels.bytes.size());
  for (std::size_t i = 0; i < light.size(); ++i) light[i] = renderer::kSrgbToLinear[pixels.bytes[i]];
  const OIIO::ImageBuf source(OIIO::ImageSpec(pixels.width, pixels.height, 3, OIIO::TypeDesc::FLOAT),
                              light.data());
  OIIO::ImageBuf target(OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::FLOAT));
  // On this thread: several pictures are made at once.
  if (!OIIO::ImageBufAlgo::resize(target, source, "triangle", 0.0f, {}, 1))
    throw std::runtime_error(target.geterror());
  light.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  target.get_pixels(target.roi(), OIIO::TypeDesc::FLOAT, light.data());
  Pixels smaller{.width = width, .height = height};
  smaller.bytes.reserve(light.size());
  for (const float x : light)
    smaller.bytes.push_back(renderer::display_byte(x, 1.0f, renderer::Tonemap::none));
  return smaller;
}

std::vector<unsigned char> encode_jpeg(const Pixels& pixels) {
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("jpeg");
  if (!output) throw std::runtime_error("cannot make a JPEG: " + OIIO::geterror());
  OIIO::ImageSpec spec(pixels.width, pixels.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("Compression", "jpeg:88");
  // Noise is coloured: half the resolution of colours would change what is compared.
  spec.attribute("jpeg:subsampling", "4:4:4");
  std::vector<unsigned char> encoded;
  OIIO::Filesystem::IOVecOutput memory(encoded);
  if (!output->set_ioproxy(&memory) || !output->open("memory.jpg", spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, pixels.bytes.data()) || !output->close()) {
    throw std::runtime_error("cannot make a JPEG: " + output->geterror());
  }
  return encoded;
}

}  // namespace

std::string picture_uri(const renderer::Picture& picture, const renderer::ImageWriteOptions& display) {
  Pixels pixels{picture.width, picture.height, renderer::display_bytes(picture, display)};
  if (pixels.width > kMaxPictureWidth) pixels = shrink(pixels, kMaxPictureWidth);
  const std::vector<unsigned char> jpeg = encode_jpeg(pixels);
  return "data:image/jpeg;base64," +
         OIIO::Strutil::base64_encode({reinterpret_cast<const char*>(jpeg.data()), jpeg.size()});
}

}  // namespace gatelight::apps

#include "base/image/webp_read.h"

#include <webp/decode.h>

#include <stdexcept>
#include <utility>

namespace gatelight {

WebpReader::WebpReader(std::vector<std::uint8_t> file) : file_(std::move(file)) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(file_.data(), file_.size(), &features) != VP8_STATUS_OK)
    throw std::runtime_error("a damaged header");
  if (features.has_animation != 0) throw std::runtime_error("an animation");
  width_ = features.width;
  height_ = features.height;
  channels_ = features.has_alpha != 0 ? 4 : 3;
}

std::vector<std::uint8_t> WebpReader::read_8() const {
  const int row = width_ * channels_;
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(row) * static_cast<std::size_t>(height_));
  const auto decode = channels_ == 4 ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
  if (decode(file_.data(), file_.size(), pixels.data(), pixels.size(), row) == nullptr)
    throw std::runtime_error("damaged or missing pixels");
  return pixels;
}

}  // namespace gatelight

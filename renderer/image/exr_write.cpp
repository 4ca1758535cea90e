#include "renderer/image/exr.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace gatelight::renderer {
namespace {

/// Keeps finite radiance finite. The conversion of `half` turns values beyond its range into infinity.
half to_half(float value) {
  constexpr float kLargest = 65504.0f;
  if (value > kLargest && value <= std::numeric_limits<float>::max()) return half(kLargest);
  if (value < -kLargest && value >= std::numeric_limits<float>::lowest()) return half(-kLargest);
  return half(value);
}

/// The address of the pixel (0, 0). It lies before the buffer when the data window starts elsewhere.
char* origin(void* base, std::size_t pixel_bytes, std::size_t row_bytes, const Picture& picture) {
  return static_cast<char*>(base) - picture.x0 * static_cast<std::ptrdiff_t>(pixel_bytes) -
         picture.y0 * static_cast<std::ptrdiff_t>(row_bytes);
}

Imf::Header make_header(const Picture& picture) {
  const int full_width = picture.full_width > 0 ? picture.full_width : picture.width;
  const int full_height = picture.full_height > 0 ? picture.full_height : picture.height;
  const Imath::Box2i display({0, 0}, {full_width - 1, full_height - 1});
  const Imath::Box2i data({picture.x0, picture.y0},
                          {picture.x0 + picture.width - 1, picture.y0 + picture.height - 1});
  Imf::Header header(display, data, 1.0f, {0.0f, 0.0f}, 1.0f, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
  for (const auto& [key, value] : picture.metadata) {
    header.insert("gatelight:" + key, Imf::StringAttribute(value));
  }
  return header;
}

}  // namespace

std::string encode_exr(const Picture& picture, bool all_float) {
  Imf::Header header = make_header(picture);
  Imf::FrameBuffer frame;
  const std::size_t width = static_cast<std::size_t>(picture.width);
  // The memory is reserved, because the frame buffer keeps addresses.
  std::vector<std::vector<half>> halves;
  halves.reserve(picture.layers.size());

  for (const Layer& layer : picture.layers) {
    const bool as_float = all_float || layer.full_precision;
    const std::size_t count = layer.channels.size();
    const std::size_t value_bytes = as_float ? sizeof(float) : sizeof(half);
    // The library's interface is not const, but it only reads from the frame buffer of an output file.
    void* base = const_cast<float*>(layer.values.data());
    if (!as_float) {
      std::vector<half>& converted = halves.emplace_back(layer.values.size());
      std::transform(layer.values.begin(), layer.values.end(), converted.begin(), to_half);
      base = converted.data();
    }
    const Imf::PixelType type = as_float ? Imf::FLOAT : Imf::HALF;
    char* first = origin(base, count * value_bytes, width * count * value_bytes, picture);
    for (std::size_t c = 0; c < count; ++c) {
      const std::string name = layer.name.empty() ? layer.channels[c] : layer.name + "." + layer.channels[c];
      header.channels().insert(name, Imf::Channel(type));
      frame.insert(
          name, Imf::Slice(type, first + c * value_bytes, count * value_bytes, width * count * value_bytes));
    }
  }

  Imf::StdOSStream output;
  {
    Imf::OutputFile file(output, header);
    file.setFrameBuffer(frame);
    file.writePixels(picture.height);
  }
  return output.str();
}

}  // namespace gatelight::renderer

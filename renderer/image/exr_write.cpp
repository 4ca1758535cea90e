#include "renderer/image/exr.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>

#include "base/parallel/loops.h"
#include "renderer/image/exr_layers.h"
#include "renderer/image/exr_stream.h"

namespace gatelight::renderer {
namespace {

/// OpenEXR multiplies points by matrices from the left.
Imath::M44f row_vectors(const std::array<float, 16>& columns) {
  Imath::M44f matrix;
  std::copy(columns.begin(), columns.end(), &matrix[0][0]);
  return matrix;
}

Imf::Header make_header(const Picture& picture) {
  const int full_width = picture.full_width > 0 ? picture.full_width : picture.width;
  const int full_height = picture.full_height > 0 ? picture.full_height : picture.height;
  const Imath::Box2i display({0, 0}, {full_width - 1, full_height - 1});
  const Imath::Box2i data({picture.x0, picture.y0},
                          {picture.x0 + picture.width - 1, picture.y0 + picture.height - 1});
  Imf::Header header(display, data, 1.0f, {0.0f, 0.0f}, 1.0f, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
  // Rec. 709, which is also the format's default; readers of other gamuts need it.
  Imf::addChromaticities(header, Imf::Chromaticities());
  if (picture.view) {
    Imf::addWorldToCamera(header, row_vectors(picture.view->world_to_camera));
    Imf::addWorldToNDC(header, row_vectors(picture.view->world_to_ndc));
  }
  for (const auto& [key, value] : picture.metadata) {
    header.insert("gatelight:" + key, Imf::StringAttribute(value));
  }
  for (const auto& [key, value] : picture.attributes) header.insert(key, Imf::StringAttribute(value));
  return header;
}

}  // namespace

void write_exr(const Picture& picture, std::FILE* stream, bool all_float) {
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
      for_each_range(converted.size(), 1 << 15, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) converted[i] = to_half(layer.values[i]);
      });
      base = converted.data();
    }
    const Imf::PixelType type = as_float ? Imf::FLOAT : Imf::HALF;
    char* first = origin(base, count * value_bytes, width * count * value_bytes, header.dataWindow());
    for (std::size_t c = 0; c < count; ++c) {
      const std::string name = layer.name.empty() ? layer.channels[c] : layer.name + "." + layer.channels[c];
      header.channels().insert(name, Imf::Channel(type));
      frame.insert(
          name, Imf::Slice(type, first + c * value_bytes, count * value_bytes, width * count * value_bytes));
    }
  }

  StdioStream output(stream);
  {
    Imf::OutputFile file(output, header, exr_threads());
    file.setFrameBuffer(frame);
    file.writePixels(picture.height);
  }
  output.check();
}

}  // namespace gatelight::renderer

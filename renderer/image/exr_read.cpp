#include "renderer/image/exr.h"

#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "base/image/claimed_size.h"
#include "renderer/image/cryptomatte.h"
#include "renderer/image/exr_layers.h"

namespace gatelight::renderer {

Picture read_exr(const std::filesystem::path& path) {
  Imf::MultiPartInputFile file(path.c_str(), 0);
  const Imf::Header& header = file.header(0);
  const Imath::Box2i data = header.dataWindow();
  const Imath::Box2i display = header.displayWindow();

  Picture picture;
  picture.width = data.max.x - data.min.x + 1;
  picture.height = data.max.y - data.min.y + 1;
  picture.x0 = data.min.x - display.min.x;
  picture.y0 = data.min.y - display.min.y;
  picture.full_width = display.max.x - display.min.x + 1;
  picture.full_height = display.max.y - display.min.y + 1;
  std::vector<StoredLayer> layers = find_layers(file);

  const std::size_t width = static_cast<std::size_t>(picture.width);
  const std::size_t pixels = width * static_cast<std::size_t>(picture.height);
  std::size_t channels = 0;
  for (const StoredLayer& stored : layers) channels += stored.channels.size();
  if (channels == 0) throw std::runtime_error("it has no channels");
  check_claimed_size(picture.width, picture.height, static_cast<std::int64_t>(channels), path);

  std::vector<Imf::FrameBuffer> frames(static_cast<std::size_t>(file.parts()));
  for (StoredLayer& stored : layers) {
    const std::size_t count = stored.channels.size();
    stored.layer.values.resize(pixels * count);
    const std::size_t pixel_bytes = count * sizeof(float);
    char* const first = origin(stored.layer.values.data(), pixel_bytes, pixel_bytes * width, data);
    for (std::size_t c = 0; c < count; ++c) {
      frames[static_cast<std::size_t>(stored.part)].insert(
          stored.channels[c],
          Imf::Slice(Imf::FLOAT, first + c * sizeof(float), pixel_bytes, pixel_bytes * width));
    }
  }
  for (int part = 0; part < file.parts(); ++part) {
    const Imf::FrameBuffer& frame = frames[static_cast<std::size_t>(part)];
    if (frame.begin() == frame.end()) continue;
    try {
      Imf::InputPart input(file, part);
      input.setFrameBuffer(frame);
      input.readPixels(data.min.y, data.max.y);
    } catch (const std::exception&) {
      if (layers.front().part == part) throw;
      std::erase_if(layers, [part](const StoredLayer& stored) { return stored.part == part; });
    }
  }
  for (StoredLayer& stored : layers) picture.layers.push_back(std::move(stored.layer));

  constexpr std::string_view kPrefix = "gatelight:";
  for (int part = 0; part < file.parts(); ++part) {
    const Imf::Header& attributes = file.header(part);
    for (auto it = attributes.begin(); it != attributes.end(); ++it) {
      const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
      const std::string_view name = it.name();
      if (text == nullptr) continue;
      if (name.starts_with(kPrefix)) picture.metadata.emplace(name.substr(kPrefix.size()), text->value());
      if (name.starts_with(kCryptomattePrefix)) picture.attributes.emplace(name, text->value());
    }
  }
  return picture;
}

}  // namespace gatelight::renderer

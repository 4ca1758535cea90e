#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepScanLineInputPart.h>
#include <OpenEXR/ImfDeepScanLineOutputPart.h>
#include <OpenEXR/ImfDeepTiledInputPart.h>
#include <OpenEXR/ImfDeepTiledOutputPart.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledInputPart.h>
#include <OpenEXR/ImfTiledOutputPart.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel/loops.h"
#include "renderer/image/exr.h"
#include "renderer/image/exr_layers.h"
#include "renderer/image/exr_stream.h"
#include "renderer/image/image_write.h"

namespace gatelight::renderer {
namespace {

std::size_t bytes_of(Imf::PixelType type) {
  return type == Imf::HALF ? sizeof(half) : sizeof(float);
}

/// A channel of a layer that replaces one of the file, or is new in it.
struct NewChannel {
  const Layer* layer;
  std::size_t index;  ///< of the channel in the layer
  Imf::PixelType type;
};

struct EditedPart {
  int number = 0;  ///< in the file that is edited
  Imf::Header header;
  std::map<std::string, NewChannel> changed;  ///< by the name in the part
  std::set<std::string> left_out;             ///< channels of the file

  /// Whether all its pixels stay.
  bool same() const { return changed.empty() && left_out.empty(); }
};

/// Whether decoding gives the same values again after encoding.
bool is_lossless(Imf::Compression compression) {
  switch (compression) {
    case Imf::NO_COMPRESSION:
    case Imf::RLE_COMPRESSION:
    case Imf::ZIPS_COMPRESSION:
    case Imf::ZIP_COMPRESSION:
    case Imf::PIZ_COMPRESSION:
      return true;
    default:
      return false;
  }
}

/// Rows, by a compression that keeps the values, with the channels that the part has now.
void make_writable(EditedPart& part) {
  Imf::Header& header = part.header;
  Imf::ChannelList channels;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    if (!part.left_out.contains(it.name())) channels.insert(it.name(), it.channel());
  }
  header.channels() = channels;
  header.erase("tiles");
  header.erase("chunkCount");
  header.setType(Imf::SCANLINEIMAGE);
  if (header.lineOrder() == Imf::RANDOM_Y) header.lineOrder() = Imf::INCREASING_Y;
  if (!is_lossless(header.compression())) header.compression() = Imf::ZIP_COMPRESSION;
}

/// Puts channels of the picture's layer where the file has its own. Those that the picture's layer does not
/// have are left out.
void replace_channels(const StoredLayer& stored, const Layer& layer, const std::vector<std::string>& changed,
                      bool as_float, EditedPart& part) {
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  Imf::ChannelList& channels = part.header.channels();
  const std::string& first = stored.channels.front();
  const std::string prefix = first.substr(0, first.rfind('.') + 1);
  const std::vector<std::string>& before = stored.layer.channels;
  for (std::size_t c = 0; c < before.size(); ++c) {
    if (!has(layer.channels, before[c])) part.left_out.insert(stored.channels[c]);
  }
  for (std::size_t c = 0; c < layer.channels.size(); ++c) {
    const std::string& name = layer.channels[c];
    const auto at = static_cast<std::size_t>(std::find(before.begin(), before.end(), name) - before.begin());
    const bool is_new = at == before.size();
    if (!is_new && !has(changed, name)) continue;
    const std::string full = is_new ? prefix + name : stored.channels[at];
    Imf::Channel channel = channels[is_new ? first : full];
    if (as_float || channel.type == Imf::UINT) channel.type = Imf::FLOAT;
    channels.insert(full, channel);
    part.changed.emplace(full, NewChannel{&layer, c, channel.type});
  }
}

/// The parts as they will be written. Layers that the picture does not have are left out, and so are parts
/// whose pixels are incomplete.
std::vector<EditedPart> edited_parts(const Imf::MultiPartInputFile& file, const Picture& picture,
                                     const LayerChannels& changed, bool as_float) {
  std::vector<EditedPart> parts;
  for (int number = 0; number < file.parts(); ++number) {
    EditedPart& part = parts.emplace_back(EditedPart{.number = number, .header = file.header(number)});
    if (!part.header.hasType())
      part.header.setType(part.header.hasTileDescription() ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
  }
  for (const StoredLayer& stored : find_layers(file)) {
    EditedPart& part = parts[static_cast<std::size_t>(stored.part)];
    const Layer* const layer = picture.find(stored.layer.name);
    const auto channels = changed.find(stored.layer.name);
    if (!layer)
      part.left_out.insert(stored.channels.begin(), stored.channels.end());
    else if (channels != changed.end())
      replace_channels(stored, *layer, channels->second, as_float, part);
  }
  for (EditedPart& part : parts) {
    if (!part.same()) make_writable(part);
  }
  std::erase_if(parts, [&](const EditedPart& part) {
    const Imf::ChannelList& channels = part.header.channels();
    return channels.begin() == channels.end() || (part.same() && !file.partComplete(part.number));
  });
  return parts;
}

/// The pixels of a part as they lie in the file.
void copy_pixels(Imf::MultiPartInputFile& from, const EditedPart& part, Imf::MultiPartOutputFile& to,
                 int number) {
  const auto copy = [&](auto&& input, auto&& output) { output.copyPixels(input); };
  const std::string& type = part.header.type();
  if (type == Imf::TILEDIMAGE) {
    copy(Imf::TiledInputPart(from, part.number), Imf::TiledOutputPart(to, number));
  } else if (type == Imf::DEEPSCANLINE) {
    copy(Imf::DeepScanLineInputPart(from, part.number), Imf::DeepScanLineOutputPart(to, number));
  } else if (type == Imf::DEEPTILE) {
    copy(Imf::DeepTiledInputPart(from, part.number), Imf::DeepTiledOutputPart(to, number));
  } else {
    copy(Imf::InputPart(from, part.number), Imf::OutputPart(to, number));
  }
}

/// One channel of a layer, as the type has it.
std::vector<char> plane_of(const NewChannel& channel, std::size_t pixels) {
  std::vector<char> plane(pixels * bytes_of(channel.type));
  const std::vector<float>& values = channel.layer->values;
  const std::size_t count = channel.layer->channels.size();
  for_each_range(pixels, 1 << 15, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const float value = values[i * count + channel.index];
      const half rounded = channel.type == Imf::HALF ? to_half(value) : half();
      const void* const from = channel.type == Imf::HALF ? static_cast<const void*>(&rounded) : &value;
      std::memcpy(&plane[i * bytes_of(channel.type)], from, bytes_of(channel.type));
    }
  });
  return plane;
}

/// Writes the rows of a part. Channels that stay are read and written in the file's own type.
void write_pixels(Imf::MultiPartInputFile& from, const EditedPart& part, Imf::MultiPartOutputFile& to,
                  int number) {
  const Imath::Box2i data = part.header.dataWindow();
  const auto width = static_cast<std::size_t>(data.max.x - data.min.x + 1);
  const auto height = static_cast<std::size_t>(data.max.y - data.min.y + 1);
  std::map<std::string, std::vector<char>> planes;  // their addresses stay
  Imf::FrameBuffer kept, all;
  const Imf::ChannelList& channels = part.header.channels();
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    const Imf::PixelType type = it.channel().type;
    const auto changed = part.changed.find(it.name());
    const bool is_kept = changed == part.changed.end();
    std::vector<char>& plane = planes[it.name()];
    plane = is_kept ? std::vector<char>(width * height * bytes_of(type))
                    : plane_of(changed->second, width * height);
    const std::size_t bytes = bytes_of(type);
    const Imf::Slice slice(type, origin(plane.data(), bytes, bytes * width, data), bytes, bytes * width);
    all.insert(it.name(), slice);
    if (is_kept) kept.insert(it.name(), slice);
  }
  if (kept.begin() != kept.end()) {
    Imf::InputPart input(from, part.number);
    input.setFrameBuffer(kept);
    input.readPixels(data.min.y, data.max.y);
  }
  Imf::OutputPart output(to, number);
  output.setFrameBuffer(all);
  output.writePixels(static_cast<int>(height));
}

}  // namespace

void edit_exr(const Picture& picture, const EditedExr& edited, std::FILE* stream, bool all_float) {
  Imf::MultiPartInputFile from(edited.file.c_str(), 0);
  std::vector<EditedPart> parts = edited_parts(from, picture, edited.channels, all_float);
  const Imath::Box2i data = from.header(0).dataWindow();
  if (parts.empty() || data.max.x - data.min.x + 1 != picture.width ||
      data.max.y - data.min.y + 1 != picture.height)
    throw std::runtime_error(fmt::format("'{}' has changed since it was read", edited.file.string()));
  for (const auto& [key, value] : picture.metadata)
    parts.front().header.insert("gatelight:" + key, Imf::StringAttribute(value));
  std::vector<Imf::Header> headers;
  for (const EditedPart& part : parts) headers.push_back(part.header);
  StdioStream output(stream);
  {
    Imf::MultiPartOutputFile to(output, headers.data(), static_cast<int>(headers.size()), false,
                                exr_threads());
    for (std::size_t i = 0; i < parts.size(); ++i)
      (parts[i].same() ? copy_pixels : write_pixels)(from, parts[i], to, static_cast<int>(i));
  }
  output.check();
}

}  // namespace gatelight::renderer

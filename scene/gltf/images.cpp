#include "scene/gltf/images.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/image/jpeg_read.h"
#include "base/image/png_read.h"
#include "base/image/webp_read.h"

namespace gatelight::scene::gltf {
namespace {

constexpr int kMaxSide = 32768;
/// Neither deflate (1032:1) nor a JPEG of one colour compresses more than this; a header that claims more is
/// wrong. A WebP file of some bytes holds a colour of any size, and is accepted up to 2048x2048.
constexpr std::size_t kMaxRatio = 2048;
constexpr std::size_t kSmall = std::size_t{1} << 20;
constexpr std::size_t kSmallWebp = std::size_t{1} << 24;

/// The bytes decide, since MIME types and file names are often wrong.
bool starts_with(Bytes bytes, std::initializer_list<std::uint8_t> magic) {
  return bytes.size() > magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
}

InputError image_error(const Document& document, std::string_view where, std::string_view what) {
  return make_error(document.file(), where, fmt::format("{}, expected a PNG, JPEG or WebP picture", what));
}

/// Throws InputError for an implausible size. Reader is PngReader, JpegReader or WebpReader.
template <class Reader>
void check_size(const Reader& reader, std::size_t value_bytes, const Document& document, Bytes bytes,
                std::string_view where, std::size_t small = kSmall) {
  const int width = reader.width(), height = reader.height(), channels = reader.channels();
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide || channels < 1) {
    throw image_error(
        document, where,
        fmt::format("{}x{} pixels of {} channels, at most {} per side", width, height, channels, kMaxSide));
  }
  const std::size_t size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                           static_cast<std::size_t>(channels) * value_bytes;
  if (size > small && size / kMaxRatio > bytes.size()) {
    throw image_error(document, where, fmt::format("{}x{} pixels in {} bytes", width, height, bytes.size()));
  }
}

template <class Reader>
Image decode_by(Reader& reader, const Document& document, Bytes bytes, std::string_view where,
                std::size_t small = kSmall) {
  check_size(reader, 1, document, bytes, where, small);
  return {"", reader.width(), reader.height(), reader.channels(), reader.read_8()};
}

Image decode_png(const Document& document, Bytes bytes, std::string_view where, bool normal_map) {
  PngReader reader({bytes.begin(), bytes.end()});
  if (normal_map && reader.bits() == 16) {
    check_size(reader, 2, document, bytes, where);
    return {"", reader.width(), reader.height(), reader.channels(), {}, reader.read_16()};
  }
  return decode_by(reader, document, bytes, where);
}

Image decode_jpeg(const Document& document, Bytes bytes, std::string_view where, Warnings& warnings) {
  JpegReader reader({bytes.begin(), bytes.end()});
  Image image = decode_by(reader, document, bytes, where);
  if (!reader.warning().empty()) warnings.add(fmt::format("{}: {}", where, reader.warning()));
  return image;
}

Image decode_webp(const Document& document, Bytes bytes, std::string_view where) {
  WebpReader reader({bytes.begin(), bytes.end()});
  return decode_by(reader, document, bytes, where, kSmallWebp);
}

bool is_webp(Bytes bytes) {
  return starts_with(bytes, {'R', 'I', 'F', 'F'}) && bytes.size() > 12 &&
         starts_with(bytes.subspan(8), {'W', 'E', 'B', 'P'});
}

/// Describes data in a format of an extension that no library here reads, and names a converter.
std::string_view known_format(Bytes bytes) {
  if (starts_with(bytes, {0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb}))
    return "a KTX2 picture without a fallback in another format ('ktx extract IN.ktx2 OUT.png' of "
           "KTX-Software converts it)";
  if (starts_with(bytes, {'D', 'D', 'S', ' '}))
    return "a DDS picture without a fallback in another format ('convert IN.dds OUT.png' of ImageMagick "
           "converts it)";
  return "neither PNG, JPEG nor WebP data";
}

Image decode(const Document& document, Bytes bytes, std::string_view where, bool normal_map,
             Warnings& warnings) try {
  if (starts_with(bytes, {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}))
    return decode_png(document, bytes, where, normal_map);
  if (starts_with(bytes, {0xff, 0xd8, 0xff})) return decode_jpeg(document, bytes, where, warnings);
  if (is_webp(bytes)) return decode_webp(document, bytes, where);
  throw image_error(document, where, known_format(bytes));
} catch (const InputError&) {
  throw;
} catch (const std::runtime_error& error) {
  throw image_error(document, where, fmt::format("cannot be decoded ({})", error.what()));
}

Image read(const Document& document, const tinygltf::Image& source, const std::string& where,
           const std::string& name, bool normal_map, Warnings& warnings) {
  const std::string named = fmt::format("{} ({})", where, name);
  if (!source.uri.empty())
    return decode(document, document.read(source.uri, where + ".uri", warnings), named, normal_map, warnings);
  if (source.bufferView < 0) throw image_error(document, where, "neither uri nor bufferView");
  return decode(document, document.view(source.bufferView, where), named, normal_map, warnings);
}

/// A pixel that leaves the surface as it is without a picture. A glow whose shape is unknown is left out.
Image stand_in(ImageUse use) {
  if (use == ImageUse::normal_map) return {"", 1, 1, 3, {}, {32768, 32768, 65535}};
  const std::uint8_t value = use == ImageUse::emission ? 0 : 255;
  return {"", 1, 1, 3, {value, value, value}};
}

}  // namespace

Image load_image(const Document& document, int index, const ImageOptions& options, Warnings& warnings) {
  const tinygltf::Image& source = element(document.model().images, index);
  const std::string where = fmt::format("images[{}]", index);
  std::string name = source.name.empty() ? uri_name(source.uri) : source.name;
  if (name.empty()) name = where;
  Image image;
  try {
    image = read(document, source, where, name, options.use == ImageUse::normal_map, warnings);
  } catch (const InputError& e) {
    if (options.missing_is_error)
      throw InputError(fmt::format("{}; `missing` warn renders without it", e.what()));
    warnings.add(fmt::format("{}; it is left out", e.what()));
    image = stand_in(options.use);
  }
  image.name = std::move(name);
  return image;
}

}  // namespace gatelight::scene::gltf

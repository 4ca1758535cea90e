#include "scene/gltf_images.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "scene/png_chunks.h"

namespace gatelight::scene::gltf {
namespace {

constexpr int kMaxSide = 32768;
/// Neither deflate (1032:1) nor a JPEG of one colour shrinks further; a header that claims more is wrong.
constexpr std::size_t kMaxRatio = 2048;
constexpr std::size_t kSmall = std::size_t{1} << 20;

/// glTF knows two formats; the bytes tell which, since MIME types and file names are often wrong.
const char* format_of(Bytes bytes) {
  constexpr std::uint8_t kPng[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  constexpr std::uint8_t kJpeg[] = {0xff, 0xd8, 0xff};
  if (bytes.size() > 8 && std::equal(std::begin(kPng), std::end(kPng), bytes.begin())) return "png";
  if (bytes.size() > 3 && std::equal(std::begin(kJpeg), std::end(kJpeg), bytes.begin())) return "jpeg";
  return nullptr;
}

SceneError image_error(const Document& document, std::string_view where, std::string_view what) {
  return make_error(document.file(), where, fmt::format("{}, expected a PNG or JPEG picture", what));
}

Image decode(const Document& document, Bytes bytes, std::string_view where) {
  const char* format = format_of(bytes);
  if (!format) throw image_error(document, where, "neither PNG nor JPEG data");
  std::vector<std::uint8_t> png;
  if (std::string_view(format) == "png") {
    std::string problem;
    png = essential_png(bytes, problem);
    if (png.empty()) throw image_error(document, where, problem);
    bytes = png;
  }

  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
  if (!input) {
    throw image_error(document, where, fmt::format("no decoder ({}) in OpenImageIO", OIIO::geterror()));
  }
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  input->set_ioproxy(&memory);
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);  // glTF's colours are not premultiplied
  OIIO::ImageSpec spec;
  if (!input->open(fmt::format("image.{}", format), spec, hints)) {
    throw image_error(document, where, fmt::format("cannot be decoded ({})", input->geterror()));
  }
  if (spec.width < 1 || spec.height < 1 || spec.width > kMaxSide || spec.height > kMaxSide ||
      spec.nchannels < 1) {
    throw image_error(document, where,
                      fmt::format("{}x{} pixels of {} channels, at most {} a side", spec.width, spec.height,
                                  spec.nchannels, kMaxSide));
  }
  Image image;
  image.width = spec.width;
  image.height = spec.height;
  image.channels = std::min(spec.nchannels, 4);
  const std::size_t size = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                           static_cast<std::size_t>(image.channels);
  if (size > kSmall && size / kMaxRatio > bytes.size()) {
    throw image_error(document, where,
                      fmt::format("{}x{} pixels in {} bytes", image.width, image.height, bytes.size()));
  }
  image.pixels.resize(size);
  if (!input->read_image(0, 0, 0, image.channels, OIIO::TypeDesc::UINT8, image.pixels.data())) {
    throw image_error(document, where, fmt::format("cannot be decoded ({})", input->geterror()));
  }
  return image;
}

Image read(const Document& document, const ImageSource& source, const std::string& where) {
  if (!source.uri.empty()) {
    const OwnedBytes bytes = document.read(source.uri, where + ".uri");
    return decode(document, bytes.bytes(), where + " (" + source.name + ")");
  }
  if (source.buffer_view < 0) throw image_error(document, where, "neither uri nor bufferView");
  return decode(document, document.view(source.buffer_view, where), where + " (" + source.name + ")");
}

}  // namespace

Image load_image(const Document& document, int index, bool missing_is_error, Warnings& warnings) {
  const ImageSource& source = document.images()[static_cast<std::size_t>(index)];
  Image image;
  try {
    image = read(document, source, fmt::format("images[{}]", index));
  } catch (const SceneError& e) {
    if (missing_is_error) throw;
    warnings.add(fmt::format("{}; white instead", e.what()));
    image = {"", 1, 1, 3, {255, 255, 255}};
  }
  image.name = source.name;
  return image;
}

}  // namespace gatelight::scene::gltf

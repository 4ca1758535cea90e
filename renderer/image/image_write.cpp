#include "renderer/image/image_write.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <new>
#include <span>
#include <utility>

#include "base/errors.h"
#include "base/image/jpeg_write.h"
#include "base/image/png_write.h"
#include "base/parallel/loops.h"
#include "renderer/image/exr.h"
#include "renderer/image/image_format.h"
#include "renderer/image/image_library.h"

namespace gatelight::renderer {
namespace {

/// Display values in [0, 1], scaled to the whole range of an integer type.
template <class Integer>
std::vector<Integer> quantized(const std::vector<float>& values) {
  constexpr float kGreatest = std::numeric_limits<Integer>::max();
  std::vector<Integer> result(values.size());
  for_each_range(values.size(), 1 << 15, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      result[i] = static_cast<Integer>(std::lround(kGreatest * values[i]));
  });
  return result;
}

template <class Integer>
std::vector<std::uint8_t> png_of(const Picture& picture, const DisplayOptions& display) {
  const std::vector<Integer> pixels = quantized<Integer>(displayed(picture, display));
  const int channels = picture.layers.front().has_alpha() ? 4 : 3;
  return encode_png(std::span<const Integer>(pixels), picture.width, picture.height, channels);
}

/// Three values a pixel, as the scene has them.
std::vector<float> radiance_of(const Picture& picture) {
  const Layer& beauty = picture.layers.front();
  const std::size_t channels = beauty.channels.size(), colors = channels - (beauty.has_alpha() ? 1 : 0);
  std::vector<float> rgb(beauty.values.size() / channels * 3);
  for (std::size_t i = 0; i < rgb.size(); ++i)
    rgb[i] = beauty.values[i / 3 * channels + std::min(i % 3, colors - 1)];
  return rgb;
}

void write_exr(const Picture& picture, std::FILE* stream, const ImageWriteOptions& options) {
  if (options.edited)
    edit_exr(picture, *options.edited, stream, options.exr_float);
  else
    write_exr(picture, stream, options.exr_float);
}

/// What write_exr() writes to a stream in memory.
std::vector<std::uint8_t> exr_of(const Picture& picture, const ImageWriteOptions& options) {
  char* data = nullptr;
  std::size_t size = 0;
  std::FILE* stream = ::open_memstream(&data, &size);
  if (stream == nullptr) throw std::bad_alloc();
  try {
    write_exr(picture, stream, options);
  } catch (...) {
    std::fclose(stream);
    std::free(data);
    throw;
  }
  // The stream's size is the place where it stands.
  const bool at_end = std::fseek(stream, 0, SEEK_END) == 0;
  const bool complete = std::fclose(stream) == 0 && at_end;
  std::vector<std::uint8_t> bytes(data, data + size);
  std::free(data);
  if (!complete) throw std::bad_alloc();
  return bytes;
}

/// The file is encoded in memory, so that AtomicFile reports every error of the disk.
std::vector<std::uint8_t> encode(const Picture& picture, ImageFormat format,
                                 const ImageWriteOptions& options) {
  constexpr int kQuality = 92;
  const auto [width, height] = std::pair{picture.width, picture.height};
  switch (format) {
    case ImageFormat::jpeg:
      return encode_jpeg(display_bytes(picture, options.display), width, height, kQuality);
    case ImageFormat::hdr:
      return image_library().encode(format, radiance_of(picture), width, height, 32);
    case ImageFormat::png:
      return options.bits == 16 ? png_of<std::uint16_t>(picture, options.display)
                                : png_of<std::uint8_t>(picture, options.display);
    default:
      return image_library().encode(format, displayed(picture, options.display), width, height, options.bits);
  }
}

/// Errors of the codecs, which do not know the file.
template <class Function>
void naming(const std::string& target, const Function& function) {
  try {
    function();
  } catch (const OutputError&) {
    throw;
  } catch (const BadOption&) {
    throw;
  } catch (const MissingLibrary&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw OutputError(fmt::format("cannot write {}: {}", target, error.what()));
  }
}

void require_known_format(const std::filesystem::path& path) {
  if (image_format(path) == ImageFormat::unknown) {
    throw UnknownFormat(
        fmt::format("cannot write '{}': its extension is '{}', supported are .exr, .png, .jpg, .tif and .hdr",
                    path.string(), path.extension().string()));
  }
}

}  // namespace

std::vector<std::uint8_t> display_bytes(const Picture& picture, const DisplayOptions& options) {
  std::vector<float> values = displayed(picture, options);
  if (!picture.layers.front().has_alpha()) return quantized<std::uint8_t>(values);
  std::vector<float> over_black;
  for (std::size_t i = 0; i < values.size(); i += 4) {
    for (std::size_t c = 0; c < 3; ++c) over_black.push_back(values[i + c] * values[i + 3]);
  }
  return quantized<std::uint8_t>(over_black);
}

void check_image_output(const std::filesystem::path& path) {
  require_known_format(path);
  check_codec(image_format(path));
  check_writable(path);
}

std::vector<std::uint8_t> encode_image(const Picture& picture, ImageFormat format,
                                       const ImageWriteOptions& options) {
  std::vector<std::uint8_t> bytes;
  naming("a picture", [&] {
    bytes = format == ImageFormat::exr ? exr_of(picture, options) : encode(picture, format, options);
  });
  return bytes;
}

void write_image(const Picture& picture, const std::filesystem::path& path,
                 const ImageWriteOptions& options) {
  require_known_format(path);
  AtomicFile file(path);
  naming(fmt::format("'{}'", path.string()), [&] {
    const ImageFormat format = image_format(path);
    if (format == ImageFormat::exr) {
      write_exr(picture, file.stream(), options);
    } else {
      const std::vector<std::uint8_t> bytes = encode(picture, format, options);
      file.write(bytes.data(), bytes.size());
    }
  });
  file.commit();
}

}  // namespace gatelight::renderer

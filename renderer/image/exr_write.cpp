#include "renderer/image/exr.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <system_error>

#include "base/half.h"
#include "base/parallel/loops.h"

namespace gatelight::renderer {
namespace {

/// OpenEXR goes back to fill in the table of line offsets, so the stream must seek.
class StdioStream final : public Imf::OStream {
 public:
  explicit StdioStream(std::FILE* stream) : Imf::OStream("stream"), stream_(stream) {}

  void write(const char* data, int bytes) override {
    if (std::fwrite(data, 1, static_cast<std::size_t>(bytes), stream_) != static_cast<std::size_t>(bytes)) {
      fail();
    }
  }
  std::uint64_t tellp() override {
    const long position = std::ftell(stream_);
    if (position < 0) fail();
    return static_cast<std::uint64_t>(position);
  }
  /// The library finishes a file in a destructor, which hides errors.
  void check() const {
    if (error_ != 0) throw_error();
  }
  void seekp(std::uint64_t position) override {
    if (std::fseek(stream_, static_cast<long>(position), SEEK_SET) != 0) fail();
  }

 private:
  [[noreturn]] void throw_error() const {
    throw std::system_error(error_, std::generic_category(), "stream");
  }
  [[noreturn]] void fail() {
    if (error_ == 0) error_ = errno;
    throw_error();
  }

  std::FILE* stream_;
  int error_ = 0;
};

/// Keeps finite radiance finite. The conversion of `half` turns values beyond its range into infinity.
half to_half(float value) {
  if (value > kMaxHalf && value <= std::numeric_limits<float>::max()) return half(kMaxHalf);
  if (value < -kMaxHalf && value >= std::numeric_limits<float>::lowest()) return half(-kMaxHalf);
  return half(value);
}

/// The address of the pixel (0, 0). It lies before the buffer when the data window starts elsewhere.
char* origin(void* base, std::size_t pixel_bytes, std::size_t row_bytes, const Picture& picture) {
  return static_cast<char*>(base) - picture.x0 * static_cast<std::ptrdiff_t>(pixel_bytes) -
         picture.y0 * static_cast<std::ptrdiff_t>(row_bytes);
}

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
    char* first = origin(base, count * value_bytes, width * count * value_bytes, picture);
    for (std::size_t c = 0; c < count; ++c) {
      const std::string name = layer.name.empty() ? layer.channels[c] : layer.name + "." + layer.channels[c];
      header.channels().insert(name, Imf::Channel(type));
      frame.insert(
          name, Imf::Slice(type, first + c * value_bytes, count * value_bytes, width * count * value_bytes));
    }
  }

  StdioStream output(stream);
  {
    const auto threads =
        static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    if (threads > 1 && Imf::globalThreadCount() < threads) Imf::setGlobalThreadCount(threads);
    Imf::OutputFile file(output, header, threads > 1 ? threads : 0);
    file.setFrameBuffer(frame);
    file.writePixels(picture.height);
  }
  output.check();
}

}  // namespace gatelight::renderer

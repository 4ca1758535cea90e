// The library that image_library() loads.

#include <OpenImageIO/color.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <system_error>

#include "base/errors.h"
#include "base/image/claimed_size.h"
#include "renderer/image/image_library.h"

namespace gatelight::renderer {
namespace {

/// Names of configurations for linear light of Rec. 709.
constexpr const char* kLinearNames[] = {"lin_rec709",
                                        "Linear Rec.709 (sRGB)",
                                        "Linear Rec.709",
                                        "lin_srgb",
                                        "Linear BT.709",
                                        "Utility - Linear - sRGB",
                                        "Utility - Linear - Rec.709"};

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Throws BadOption, about the option, where the name is not one of `names`.
void require(const std::vector<std::string>& names, const std::string& name, const char* option) {
  if (!has(names, name))
    throw BadOption({option, name, "", fmt::format("one of '{}'", fmt::join(names, "', '"))});
}

std::string linear_name(const OIIO::ColorConfig& config) {
  const std::vector<std::string> names = config.getColorSpaceNames();
  for (const char* name : kLinearNames) {
    if (has(names, name)) return name;
  }
  const char* const scene_linear = config.getColorSpaceNameByRole("scene_linear");
  return scene_linear ? scene_linear : "linear";
}

/// The library's own files in memory cannot be read, which libtiff does while it writes.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("picture", MFD_CLOEXEC)) {
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "memory for a picture");
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }
  std::vector<std::uint8_t> read() const {
    std::ifstream file(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

 private:
  int descriptor_;
};

class OpenImageIO final : public ImageLibrary {
 public:
  Picture read_hdr(const std::filesystem::path& path) const override {
    // The format is given by name. Otherwise the library tries every format it knows on a file that is not
    // HDR.
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create("hdr");
    if (!input) throw std::runtime_error(OIIO::geterror());
    OIIO::ImageSpec spec;
    if (!input->open(path.string(), spec)) throw std::runtime_error(input->geterror());
    check_claimed_size(spec.width, spec.height, spec.nchannels, path);
    Picture picture{.width = spec.width, .height = spec.height};
    Layer beauty{.channels = {"R", "G", "B"}, .full_precision = true};
    beauty.values.resize(std::size_t{3} * static_cast<std::size_t>(spec.width) *
                         static_cast<std::size_t>(spec.height));
    if (!input->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, beauty.values.data()))
      throw std::runtime_error(input->geterror());
    picture.layers.push_back(std::move(beauty));
    return picture;
  }

  std::vector<float> resize(const std::vector<float>& rgb, int width, int height, int to_width,
                            int to_height) const override {
    const OIIO::ImageBuf source(OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::FLOAT),
                                const_cast<float*>(rgb.data()));
    OIIO::ImageBuf target(OIIO::ImageSpec(to_width, to_height, 3, OIIO::TypeDesc::FLOAT));
    if (!OIIO::ImageBufAlgo::resize(target, source, "triangle", 0.0f, {}, 1))
      throw std::runtime_error(target.geterror());
    std::vector<float> result(std::size_t{3} * static_cast<std::size_t>(to_width) *
                              static_cast<std::size_t>(to_height));
    target.get_pixels(target.roi(), OIIO::TypeDesc::FLOAT, result.data());
    return result;
  }

  std::vector<std::uint8_t> encode(ImageFormat format, const std::vector<float>& values, int width,
                                   int height, int bits) const override {
    const std::unique_ptr<OIIO::ImageOutput> output =
        OIIO::ImageOutput::create(format == ImageFormat::hdr ? "hdr" : "tiff");
    if (!output) throw std::runtime_error(OIIO::geterror());
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const int channels = static_cast<int>(values.size() / pixels);
    OIIO::ImageSpec spec(width, height, channels,
                         bits == 32   ? OIIO::TypeDesc::FLOAT
                         : bits == 16 ? OIIO::TypeDesc::UINT16
                                      : OIIO::TypeDesc::UINT8);
    if (bits != 32) spec["oiio:ColorSpace"] = "sRGB";
    if (format == ImageFormat::tiff) spec["compression"] = "zip";
    // The time of writing would make equal pictures differ.
    spec["DateTime"] = "";
    spec["oiio:UnassociatedAlpha"] = 1;
    const MemoryFile file;
    if (!output->open(file.path(), spec) || !output->write_image(OIIO::TypeDesc::FLOAT, values.data()) ||
        !output->close())
      throw std::runtime_error(output->geterror());
    return file.read();
  }

  void show(std::vector<float>& rgb, const OcioView& ocio) const override {
    OIIO::ColorConfig config(ocio.config);
    if (config.has_error()) throw BadOption({"ocio", ocio.config, "cannot be used: " + config.geterror()});
    const auto or_default = [](const std::string& name, const char* usual) {
      return name.empty() ? std::string(usual ? usual : "") : name;
    };
    const std::string display = or_default(ocio.display, config.getDefaultDisplayName());
    require(config.getDisplayNames(), display, "ocio-display");
    const std::string view = or_default(ocio.view, config.getDefaultViewName(display));
    require(config.getViewNames(display), view, "ocio-view");
    const OIIO::ColorProcessorHandle processor =
        config.createDisplayTransform(display, view, linear_name(config));
    if (!processor) throw BadOption({"ocio", ocio.config, "cannot be used: " + config.geterror()});
    const int pixels = static_cast<int>(rgb.size() / 3);
    processor->apply(rgb.data(), pixels, 1, 3, sizeof(float), 3 * sizeof(float),
                     std::size_t{3} * sizeof(float) * static_cast<std::size_t>(pixels));
    // NaN becomes 0.
    for (float& x : rgb) x = x > 0.0f ? std::min(x, 1.0f) : 0.0f;
  }
};

}  // namespace
}  // namespace gatelight::renderer

extern "C" const gatelight::renderer::ImageLibrary* gatelight_image_library() {
  static const gatelight::renderer::OpenImageIO library;
  return &library;
}

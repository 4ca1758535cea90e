// The library that image_library() loads.

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "renderer/image/claimed_size.h"
#include "renderer/image/image_library.h"

namespace gatelight::renderer {
namespace {

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
};

}  // namespace
}  // namespace gatelight::renderer

extern "C" const gatelight::renderer::ImageLibrary* gatelight_image_library() {
  static const gatelight::renderer::OpenImageIO library;
  return &library;
}

#include "apps/preview_video.h"

#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <optional>

#include "apps/settings/frame_flags.h"
#include "apps/settings/picture_output.h"
#include "apps/video_encoder.h"
#include "base/errors.h"
#include "renderer/image/image_read.h"

namespace gatelight::apps {
namespace {

using renderer::Picture;

/// Colours of a picture times its alpha, as those of a renderer are; PNG has them without it.
void multiply_by_alpha(renderer::Layer& layer) {
  if (!layer.has_alpha()) return;
  const std::size_t channels = layer.channels.size();
  for (std::size_t i = 0; i < layer.values.size(); ++i)
    layer.values[i] *= i % channels + 1 < channels ? layer.values[i - i % channels + channels - 1] : 1.0f;
}

/// A frame's file as it is displayed.
std::vector<std::uint8_t> shown(Picture picture, const std::string& file, const RenderSettings& settings) {
  if (output_format(file) == renderer::ImageFormat::png) {
    multiply_by_alpha(picture.layers.front());
    return renderer::display_bytes(picture);
  }
  renderer::DisplayOptions display = settings.image.display;
  display.exposure = settings.exposure.value_or(0.0f);
  return renderer::display_bytes(picture, display);
}

/// Frames that are not part of the film, with the reason of the first.
class LeftOut {
 public:
  void add(int frame, const std::string& why) {
    if (count_++ == 0) first_ = fmt::format("frame {}: {}", frame, why);
  }
  void warn(const FilmCallbacks& callbacks) const {
    if (count_ == 0) return;
    callbacks.warn(count_ == 1 ? fmt::format("the film leaves out {}", first_)
                               : fmt::format("the film leaves out {} frames; {}", count_, first_));
  }

 private:
  std::size_t count_ = 0;
  std::string first_;
};

}  // namespace

std::size_t write_film(const RenderSettings& settings, const std::vector<int>& frames,
                       const FilmCallbacks& callbacks) {
  const std::string source = film_source(settings.outputs);
  // With steps the film keeps the animation's speed.
  FilmSize size{.fps = settings.frames.fps / std::abs(common_step(settings.frames.range->numbers()))};
  std::optional<VideoEncoder> encoder;
  LeftOut left_out;
  std::size_t done = 0, added = 0;
  for (const int frame : frames) {
    if (callbacks.stop()) return 0;
    const std::string file = name_of_frame(source, frame);
    try {
      Picture picture = renderer::read_image(file);
      if (encoder && (picture.width != size.width || picture.height != size.height))
        throw InputError(fmt::format("'{}' has {}x{} pixels, expected {}x{}", file, picture.width,
                                     picture.height, size.width, size.height));
      size.width = picture.width;
      size.height = picture.height;
      if (!encoder) encoder.emplace(settings.frames.film, size);
      if (!encoder->add(shown(std::move(picture), file, settings), callbacks.stop)) return 0;
      ++added;
    } catch (const InputError& error) {
      left_out.add(frame, error.what());
    }
    callbacks.progress(++done);
  }
  left_out.warn(callbacks);
  if (!encoder)
    throw OutputError(fmt::format("cannot write '{}': there is no frame for it", settings.frames.film));
  encoder->finish();
  return added;
}

}  // namespace gatelight::apps

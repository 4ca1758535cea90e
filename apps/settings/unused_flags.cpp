#include "apps/settings/unused_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <set>

#include "apps/settings/picture_output.h"

namespace gatelight::apps {

using renderer::ImageFormat;

bool shows_on_a_screen(const std::vector<std::string>& outputs) {
  return std::any_of(outputs.begin(), outputs.end(), [](const std::string& output) {
    const ImageFormat format = output_format(output);
    return format == ImageFormat::png || format == ImageFormat::jpeg || format == ImageFormat::tiff;
  });
}

std::vector<std::string> unused_output_flags(const RenderSettings& settings) {
  std::set<ImageFormat> formats;
  for (const std::string& output : settings.outputs) formats.insert(output_format(output));
  const auto any = [&](std::initializer_list<ImageFormat> wanted) {
    return std::any_of(wanted.begin(), wanted.end(), [&](ImageFormat f) { return formats.contains(f); });
  };
  std::vector<std::string> unused;
  const auto need = [&](std::initializer_list<const char*> flags, bool useful, const char* what) {
    for (const char* flag : flags) {
      if (settings.given.contains(flag) && !useful)
        unused.push_back(fmt::format("{} changes nothing: {}", flag, what));
    }
  };
  const bool displayed = shows_on_a_screen(settings.outputs);
  need({"--exposure", "--white-balance", "--tonemap", "--ocio"}, displayed,
       "no output is a .png, .jpg or .tif");
  need({"--tonemap"}, settings.image.display.ocio.config.empty(), "the view of --ocio has its own curve");
  need({"--ocio-display", "--ocio-view"}, !settings.image.display.ocio.config.empty(), "there is no --ocio");
  need({"--bits"}, any({ImageFormat::png, ImageFormat::tiff}), "no output is a .png or .tif");
  need({"--exr", "--aov", "--cryptomatte", "--light-groups"}, any({ImageFormat::exr}),
       "no output is an .exr");
  return unused;
}

}  // namespace gatelight::apps

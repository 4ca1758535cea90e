#include "apps/settings/unused_flags.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "apps/settings/option_table.h"
#include "apps/settings/picture_output.h"

namespace gatelight::apps {

using renderer::ImageFormat;

bool shows_on_a_screen(const std::vector<std::string>& outputs) {
  return std::any_of(outputs.begin(), outputs.end(), [](const std::string& output) {
    const ImageFormat format = output_format(output);
    return format == ImageFormat::png || format == ImageFormat::jpeg || format == ImageFormat::tiff;
  });
}

std::vector<std::string> unused_output_flags(RenderSettings settings) {
  std::set<ImageFormat> formats;
  for (const std::string& output : settings.outputs) formats.insert(output_format(output));
  std::vector<std::string> unused;
  for (const Option& option : option_table(settings)) {
    if (!settings.given.contains(option.name) || option.marks.formats.empty()) continue;
    std::vector<std::string_view> extensions;
    bool useful = false;
    for (const ImageFormat format : option.marks.formats) {
      useful |= formats.contains(format);
      extensions.push_back(renderer::extension_of(format));
    }
    if (!useful)
      unused.push_back(
          fmt::format("{} changes nothing: no output is {}", option.flag(), fmt::join(extensions, " or ")));
  }
  const bool has_ocio = !settings.image.display.ocio.config.empty();
  for (const char* name : {"ocio-display", "ocio-view"}) {
    if (settings.given.contains(name) && !has_ocio)
      unused.push_back(fmt::format("--{} changes nothing: there is no --ocio", name));
  }
  if (settings.given.contains("tonemap") && has_ocio)
    unused.emplace_back("--tonemap changes nothing: the view of --ocio has its own curve");
  return unused;
}

}  // namespace gatelight::apps

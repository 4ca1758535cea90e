#include "apps/reports/overflow_warning.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/settings/picture_output.h"
#include "renderer/image/half_overflow.h"

namespace gatelight::apps {

std::string overflow_warning(const renderer::Picture& picture, std::span<const std::string> outputs,
                             const renderer::ImageWriteOptions& image) {
  const bool as_half =
      !image.exr_float && std::any_of(outputs.begin(), outputs.end(), [](const auto& output) {
        return output_format(output) == renderer::ImageFormat::exr;
      });
  if (!as_half) return "";
  std::string layers;
  for (const renderer::HalfOverflow& found : renderer::half_overflows(picture)) {
    layers += fmt::format("{}{} in {}", layers.empty() ? "" : ", ", found.values,
                          found.layer.empty() ? "the picture" : "'" + found.layer + "'");
  }
  if (layers.empty()) return "";
  return fmt::format("values beyond 65504, the largest half, are stored as 65504: {}; --exr float keeps them",
                     layers);
}

}  // namespace gatelight::apps

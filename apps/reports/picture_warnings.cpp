#include "apps/reports/picture_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

#include "apps/settings/picture_output.h"
#include "renderer/image/half_overflow.h"
#include "scene/light_names.h"

namespace gatelight::apps {
namespace {

/// The radiance of a white surface that faces a light, for point and spot lights at the distance of the
/// scene's radius.
float white_in_light(const scene::PunctualLight& light, float radius) {
  const float intensity = light.intensity.maxCoeff() * kInvPi;
  return light.type == scene::LightType::directional ? intensity : intensity / (radius * radius);
}

/// The share of the pixels that are shown as pure white.
double white_share(const renderer::Picture& picture, const renderer::DisplayOptions& display) {
  const std::vector<std::uint8_t> bytes = renderer::display_bytes(picture, display);
  std::size_t white = 0;
  for (std::size_t i = 0; i < bytes.size(); i += 3)
    white += std::min({bytes[i], bytes[i + 1], bytes[i + 2]}) == 255 ? 1 : 0;
  return bytes.empty() ? 0.0 : 3.0 * static_cast<double>(white) / static_cast<double>(bytes.size());
}

}  // namespace

std::string lights_from_watts(const scene::Scene& scene) {
  // Sixteen times as bright as white: a lamp of 40 W at 2 m, as Blender exports it, gives 170.
  constexpr float kTooBright = 16.0f;
  constexpr std::size_t kMaxNames = 3;
  const float radius = std::max(0.5f * scene.bounds.diagonal().norm(), 1e-3f);
  std::set<std::string> names;
  for (const scene::PunctualLight& light : scene.lights) {
    if (white_in_light(light, radius) > kTooBright) names.insert(light.name);
  }
  if (names.empty()) return "";
  const scene::LightNames all(scene);
  if (all.materials.empty() && names == all.lights) return "*=0.00146";
  const bool plain =
      names.size() <= kMaxNames && std::none_of(names.begin(), names.end(), [](const auto& name) {
        return name.empty() || name.find_first_of("*=;'\"") != std::string::npos;
      });
  if (!plain) return "NAME=0.00146";
  std::string text;
  for (const std::string& name : names) text += fmt::format("{}{}=0.00146", text.empty() ? "" : ";", name);
  return text;
}

std::string glare_warning(const renderer::Picture& picture, const renderer::DisplayOptions& display,
                          float suitable_stops, const std::string& lights) {
  constexpr float kStopsTooBright = 4.0f;
  constexpr double kShare = 1.0 / 3.0;
  if (display.exposure - suitable_stops < kStopsTooBright) return "";
  const double share = white_share(picture, display);
  if (share <= kShare) return "";
  std::string text = fmt::format("{:.0f} % of the pixels are clipped to white; --exposure {:.1f} shows them",
                                 100.0 * share, suitable_stops);
  if (!lights.empty())
    text += fmt::format(
        ". Lights that were exported from watts by 683 lm/W are 683 times too bright here; --lights '{}' "
        "corrects them",
        lights);
  return text;
}

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

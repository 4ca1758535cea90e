#include "apps/settings/light_words.h"

#include <fmt/format.h>

#include <array>

#include "renderer/machine/errors.h"
#include "renderer/settings/values.h"

namespace gatelight::apps {
namespace {

constexpr renderer::RealRange kFactor{0.0, 1e30};

scene::LightAdjustment read_light(const std::string& flag, const std::string& text) {
  // Names may contain '='; values do not.
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0)
    throw renderer::BadOption(fmt::format("{}: '{}' is not NAME=off, NAME=X or NAME=r,g,b", flag, text));
  const std::string value = text.substr(equals + 1);
  scene::LightAdjustment light{.name = text.substr(0, equals)};
  if (value == "off") {
    light.factor = scene::Color::Zero();
  } else if (value.find(',') != std::string::npos) {
    const std::array<float, 3> rgb = renderer::parse_triple(flag, value, kFactor);
    light.factor = {rgb[0], rgb[1], rgb[2]};
  } else {
    light.factor = scene::Color::Constant(renderer::parse_float(flag, value, kFactor));
  }
  return light;
}

}  // namespace

std::vector<scene::LightAdjustment> read_lights(const std::string& flag, const std::string& text) {
  std::vector<scene::LightAdjustment> lights;
  for (const std::string& part : renderer::split(text, ';')) lights.push_back(read_light(flag, part));
  return lights;
}

std::string text_of(const std::vector<scene::LightAdjustment>& lights) {
  std::string text;
  for (const scene::LightAdjustment& light : lights) {
    const scene::Color& f = light.factor;
    const bool grey = f.x() == f.y() && f.y() == f.z();
    const std::string value = (f == 0.0f).all() ? "off"
                              : grey            ? fmt::format("{}", f.x())
                                                : fmt::format("{},{},{}", f.x(), f.y(), f.z());
    text += fmt::format("{}{}={}", text.empty() ? "" : ";", light.name, value);
  }
  return text;
}

std::vector<scene::LightProfile> read_profiles(const std::string& flag, const std::string& text) {
  std::vector<scene::LightProfile> profiles;
  for (const std::string& part : renderer::split(text, ';')) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == part.size())
      throw renderer::BadOption(fmt::format("{}: '{}' is not NAME=FILE", flag, part));
    profiles.push_back({part.substr(0, equals), part.substr(equals + 1)});
  }
  return profiles;
}

std::string text_of(const std::vector<scene::LightProfile>& profiles) {
  std::string text;
  for (const scene::LightProfile& profile : profiles)
    text += fmt::format("{}{}={}", text.empty() ? "" : ";", profile.name, profile.file);
  return text;
}

}  // namespace gatelight::apps

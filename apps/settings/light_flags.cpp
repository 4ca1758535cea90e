#include "apps/settings/light_flags.h"

#include <fmt/format.h>

#include <array>

#include "apps/settings/parsing.h"
#include "base/errors.h"

namespace gatelight::apps {
namespace {

constexpr RealRange kFactor{0.0, 1e30};

scene::LightAdjustment read_light(const std::string& option, const std::string& text) {
  // Names may contain '='; values do not.
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0)
    throw BadOption({option, text, "", "NAME=off, NAME=X or NAME=r,g,b"});
  const std::string value = text.substr(equals + 1);
  scene::LightAdjustment light{.name = text.substr(0, equals)};
  if (value == "off") {
    light.factor = Color::Zero();
  } else if (value.find(',') != std::string::npos) {
    const std::array<float, 3> rgb = parse_triple(option, value, kFactor);
    light.factor = {rgb[0], rgb[1], rgb[2]};
  } else {
    light.factor = Color::Constant(parse_float(option, value, kFactor));
  }
  return light;
}

}  // namespace

std::vector<scene::LightAdjustment> read_lights(const std::string& option, const std::string& text) {
  std::vector<scene::LightAdjustment> lights;
  for (const std::string& part : split(text, ';')) lights.push_back(read_light(option, part));
  return lights;
}

std::string text_of(const std::vector<scene::LightAdjustment>& lights) {
  std::string text;
  for (const scene::LightAdjustment& light : lights) {
    const Color& f = light.factor;
    const bool grey = f.x() == f.y() && f.y() == f.z();
    const std::string value = (f == 0.0f).all() ? "off"
                              : grey            ? fmt::format("{}", f.x())
                                                : fmt::format("{},{},{}", f.x(), f.y(), f.z());
    text += fmt::format("{}{}={}", text.empty() ? "" : ";", light.name, value);
  }
  return text;
}

std::vector<scene::LightProfile> read_profiles(const std::string& option, const std::string& text) {
  std::vector<scene::LightProfile> profiles;
  for (const std::string& part : split(text, ';')) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == part.size())
      throw BadOption({option, part, "", "NAME=FILE"});
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

std::vector<renderer::LightGroup> read_light_groups(const std::string& option, const std::string& text) {
  if (text == "none") return {};
  std::vector<renderer::LightGroup> groups;
  for (const std::string& part : split(text, ';')) {
    const std::size_t equals = part.find('=');  // names of groups have none
    if (equals == std::string::npos) throw BadOption({option, part, "", "NAME=LIGHT,LIGHT"});
    groups.push_back({part.substr(0, equals), split(part.substr(equals + 1), ',')});
  }
  renderer::check_light_groups(groups);
  return groups;
}

}  // namespace gatelight::apps

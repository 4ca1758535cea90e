#include "apps/settings/light_words.h"

#include <fmt/format.h>

#include <algorithm>
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
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    lights.push_back(read_light(flag, text.substr(begin, end - begin)));
    begin = end + 1;
  }
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

}  // namespace gatelight::apps

#include "apps/settings/light_flags.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <chrono>
#include <functional>
#include <map>
#include <set>

#include "apps/settings/parsing.h"
#include "base/errors.h"

namespace gatelight::apps {
namespace {

using renderer::SkyOptions;
using renderer::SunTime;

struct Part {
  std::string name;
  std::vector<std::string> values;
};

/// "a=1,2, b=3" are two parts: a word without '=' belongs to the part before it.
std::vector<Part> parts_of(const std::string& option, const std::string& text) {
  std::vector<Part> parts;
  for (const std::string& piece : split_list(option, text)) {
    const std::string word = trimmed(piece);
    const std::size_t equals = word.find('=');
    if (equals != std::string::npos) {
      parts.push_back({trimmed(word.substr(0, equals)), {trimmed(word.substr(equals + 1))}});
    } else if (!parts.empty()) {
      parts.back().values.push_back(word);
    } else {
      throw BadOption({option, text, "", "none, clear, or parts such as sun=AZIMUTH,ELEVATION"});
    }
  }
  return parts;
}

/// Whole numbers with a separator between them: "2026-06-21", "14:30".
std::vector<int> whole_numbers(const std::string& option, const std::string& text, char separator,
                               const char* expected) {
  std::vector<int> numbers;
  for (const std::string& digits : split(text, separator)) {
    const bool good =
        !digits.empty() && digits.size() <= 4 && digits.find_first_not_of("0123456789") == std::string::npos;
    if (!good) throw BadOption({option, text, "", expected});
    numbers.push_back(std::stoi(digits));
  }
  return numbers;
}

void read_date(const std::string& option, const std::string& text, SunTime& time) {
  constexpr const char* kExpected = "a date YEAR-MONTH-DAY from 1900 to 2100, such as 2026-06-21";
  const std::vector<int> n = whole_numbers(option, text, '-', kExpected);
  // The types of dates keep eight bits.
  if (n.size() != 3 || n[0] < 1900 || n[0] > 2100 || n[1] > 12 || n[2] > 31)
    throw BadOption({option, text, "", kExpected});
  const std::chrono::year_month_day date{std::chrono::year(n[0]),
                                         std::chrono::month(static_cast<unsigned>(n[1])),
                                         std::chrono::day(static_cast<unsigned>(n[2]))};
  if (!date.ok()) throw BadOption({option, text, "", kExpected});
  time.year = n[0];
  time.month = n[1];
  time.day = n[2];
}

void read_time(const std::string& option, const std::string& text, SunTime& time) {
  constexpr const char* kExpected = "a time HOUR:MINUTE or HOUR:MINUTE:SECOND of the day, such as 14:30";
  std::vector<int> n = whole_numbers(option, text, ':', kExpected);
  if (n.size() == 2) n.push_back(0);
  if (n.size() != 3 || n[0] > 23 || n[1] > 59 || n[2] > 59) throw BadOption({option, text, "", kExpected});
  time.second_of_day = (n[0] * 60 + n[1]) * 60 + n[2];
}

/// Number of values of a part, and the function that reads them.
struct Reader {
  std::size_t values = 1;
  std::function<void(const std::vector<std::string>& values)> read;
};

Reader real(const std::string& option, float& member, const RealRange& range) {
  return {1, [&option, &member, range](const std::vector<std::string>& values) {
            member = parse_float(option, values[0], range);
          }};
}

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

renderer::SkyOptions read_sky(const std::string& option, const std::string& text) {
  SkyOptions sky;
  if (trimmed(text) == "clear") return sky;
  SunTime time;
  constexpr RealRange kLatitude{-90.0, 90.0}, kLongitude{-180.0, 180.0}, kZone{-14.0, 14.0};
  const std::map<std::string, Reader> readers = {
      {"turbidity", real(option, sky.turbidity, {1.0, 10.0})},
      {"ground", real(option, sky.ground, {0.0, 1.0})},
      {"size", real(option, sky.sun_size_degrees, {0.0, 20.0})},
      {"intensity", real(option, sky.intensity, {0.0, 1e6})},
      {"sun",
       {2,
        [&](const std::vector<std::string>& values) {
          sky.sun_azimuth_degrees = parse_float(option, values[0], {-360.0, 360.0});
          sky.sun_elevation_degrees = parse_float(option, values[1], {-90.0, 90.0});
        }}},
      {"date", {1, [&](const std::vector<std::string>& values) { read_date(option, values[0], time); }}},
      {"time", {1, [&](const std::vector<std::string>& values) { read_time(option, values[0], time); }}},
      {"place",
       {2,
        [&](const std::vector<std::string>& values) {
          time.latitude_degrees = parse_real(option, values[0], kLatitude);
          time.longitude_degrees = parse_real(option, values[1], kLongitude);
        }}},
      {"zone", {1, [&](const std::vector<std::string>& values) {
                  const bool plus = values[0].starts_with('+');
                  time.zone_hours = parse_real(option, plus ? values[0].substr(1) : values[0], kZone);
                }}}};
  std::set<std::string> given;
  for (const Part& part : parts_of(option, text)) {
    const std::string whole = fmt::format("{}={}", part.name, fmt::join(part.values, ","));
    const auto found = readers.find(part.name);
    if (found == readers.end())
      refuse_choice(option, part.name, "turbidity|sun|date|time|place|zone|ground|size|intensity");
    if (!given.insert(part.name).second)
      throw BadOption({option, "", fmt::format("{}= is given twice", part.name), "it once"});
    if (part.values.size() != found->second.values)
      throw BadOption({option, whole, "", found->second.values == 2 ? "two numbers a,b" : "one value"});
    try {
      found->second.read(part.values);
    } catch (const BadOption& error) {
      throw BadOption({option, whole, error.parts().problem, error.parts().expected});
    }
  }
  if (sky.sun_size_degrees > 0.0f && sky.sun_size_degrees < 0.05f)
    throw BadOption({option, fmt::format("size={}", sky.sun_size_degrees), "", "0 or at least 0.05 degrees"});
  const bool dated = given.contains("date");
  for (const char* other : {"time", "place"}) {
    if (dated && !given.contains(other))
      throw BadOption({option, "", fmt::format("{}= is missing", other), "it together with date="});
  }
  for (const char* other : {"time", "place", "zone"}) {
    if (!dated && given.contains(other))
      throw BadOption({option, "", "date= is missing", fmt::format("it together with {}=", other)});
  }
  if (dated && given.contains("sun"))
    throw BadOption({option, "", "sun= and date= exclude each other", "one of them"});
  if (dated) sky.time = time;
  return sky;
}

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

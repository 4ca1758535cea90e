#include "apps/reports/picture_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>
#include <vector>

#include "apps/reports/recipe.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/text.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using renderer::Picture;
using Rows = std::vector<std::pair<std::string, std::string>>;

const char* const kOptions = "options";
const char* const kCommand = "command";

bool is_cut(const Picture& picture) {
  return picture.full_width > 0 &&
         (picture.full_width != picture.width || picture.full_height != picture.height);
}

std::string size_text(const Picture& picture) {
  std::string text = fmt::format("{} x {}", picture.width, picture.height);
  if (is_cut(picture)) {
    text +=
        fmt::format(" at {}, {} of {} x {}", picture.x0, picture.y0, picture.full_width, picture.full_height);
  }
  return text;
}

std::string layer_text(const renderer::Layer& layer) {
  return fmt::format("{} ({})", layer.name.empty() ? "beauty" : layer.name, fmt::join(layer.channels, ","));
}

/// The option as its flag takes it; empty where it has no value.
std::string option_text(const std::string& name, const ordered_json& value) {
  if (name == "size" && value.is_array() && value.size() == 2)
    return fmt::format("{}x{}", flag_text(value[0]), flag_text(value[1]));
  return flag_text(value);
}

Rows rows_of(const std::string& file, const Picture& picture) {
  Rows rows = {{"picture", file}, {"size", size_text(picture)}};
  for (std::size_t i = 0; i < picture.layers.size(); ++i)
    rows.emplace_back(i == 0 ? "layers" : "", layer_text(picture.layers[i]));
  const ordered_json options = recipe_options(picture);
  for (const auto& [key, value] : picture.metadata) {
    if (key != kOptions || options.is_discarded()) rows.emplace_back(key, value);
  }
  if (options.is_discarded()) return rows;
  for (const auto& [name, value] : options.items()) {
    if (const std::string text = option_text(name, value); !text.empty())
      rows.emplace_back("--" + name, text);
  }
  return rows;
}

/// Numbers of the recipe; all other entries are texts.
const std::set<std::string> kNumbers = {
    "seed", "spp", "threads", "estimated_error", "build_seconds", "render_seconds", "seconds"};

ordered_json recipe_json(const Picture& picture) {
  ordered_json recipe = ordered_json::object();
  for (const auto& [key, value] : picture.metadata) {
    const ordered_json number =
        kNumbers.contains(key) ? ordered_json::parse(value, nullptr, false) : ordered_json();
    recipe[key] = number.is_number() ? number : ordered_json(value);
  }
  const ordered_json options = recipe_options(picture);
  if (!options.is_discarded()) recipe[kOptions] = options;
  return recipe;
}

}  // namespace

void require_recipe(const std::string& file, const Picture& picture) {
  if (picture.metadata.empty())
    throw InputError(fmt::format("'{}' has no recipe, expected an EXR that gatelight wrote", file));
}

std::string picture_report_text(const std::string& file, const Picture& picture) {
  const Rows rows = rows_of(file, picture);
  std::size_t width = 0;
  for (const auto& [name, value] : rows) width = std::max(width, name.size());
  std::string text;
  // Names and values may hold anything; control characters must not reach the terminal.
  for (const auto& [name, value] : rows)
    text += one_line(fmt::format("{:<{}}  {}", name, width, value)) + "\n";
  return text;
}

ordered_json picture_report_json(const std::string& file, const Picture& picture) {
  ordered_json json = {
      {"schema", 1}, {"picture", file}, {"width", picture.width}, {"height", picture.height}};
  if (is_cut(picture)) {
    json["x0"] = picture.x0;
    json["y0"] = picture.y0;
    json["full_width"] = picture.full_width;
    json["full_height"] = picture.full_height;
  }
  json["layers"] = ordered_json::array();
  for (const renderer::Layer& layer : picture.layers)
    json["layers"].push_back({{"name", layer.name}, {"channels", layer.channels}});
  json["recipe"] = recipe_json(picture);
  return json;
}

std::string picture_command(const std::string& file, const Picture& picture) {
  const auto found = picture.metadata.find(kCommand);
  if (found == picture.metadata.end()) {
    throw InputError(fmt::format(
        "'{}' has no command line in its recipe, expected an EXR made without --reproducible", file));
  }
  return one_line(found->second) + "\n";
}

}  // namespace gatelight::apps

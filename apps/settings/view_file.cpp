#include "apps/settings/view_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "apps/settings/option_table.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/text.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

/// Whether options beside the file replace a member: its own, or one that excludes it.
bool replaced(const std::set<std::string>& given, const Option& member) {
  return given.contains(member.name) ||
         std::any_of(member.marks.excludes.begin(), member.marks.excludes.end(),
                     [&](const std::string& other) { return given.contains(other); });
}

ordered_json read_object(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(fmt::format("cannot read the view '{}': there is no such file", path));
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  ordered_json view = ordered_json::parse(text, nullptr, false);
  if (!view.is_object())
    throw InputError(fmt::format("cannot read the view '{}': it is no JSON object", path));
  return view;
}

}  // namespace

void read_view_file(RenderSettings& settings) {
  if (settings.view_file.empty()) return;
  const ordered_json view = read_object(settings.view_file);
  std::vector<Option> table = option_table(settings);
  std::erase_if(table, [](const Option& option) { return !option.marks.of_view; });
  for (const auto& [name, value] : view.items()) {
    const auto option = std::find_if(table.begin(), table.end(),
                                     [&wanted = name](const Option& o) { return o.name == wanted; });
    if (option == table.end()) {
      std::vector<std::string> names;
      for (const Option& o : table) names.push_back(o.name);
      throw InputError(fmt::format("the view '{}' has the unknown member '{}', expected some of {}",
                                   settings.view_file, name, fmt::join(names, ", ")));
    }
    if (value.is_null() || replaced(settings.given, *option)) continue;
    try {
      option->read(flag_text(value));
    } catch (const BadOption& error) {
      throw InputError(fmt::format("the view '{}': {}", settings.view_file, error.what()));
    }
  }
}

}  // namespace gatelight::apps

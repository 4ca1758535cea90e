#include "apps/python/keywords.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "apps/settings/other_tools.h"
#include "base/errors.h"
#include "base/nearest_word.h"
#include "renderer/settings/presets.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;
using apps::Option;

std::string keyword_of(std::string flag) {
  std::replace(flag.begin(), flag.end(), '-', '_');
  return flag;
}

bool is_sequence(py::handle value) {
  return py::isinstance<py::tuple>(value) || py::isinstance<py::list>(value) ||
         (py::hasattr(value, "tolist") && py::hasattr(value, "__len__") && py::hasattr(value, "shape") &&
          py::len(value.attr("shape")) > 0);
}

std::string joined(const std::string& option, py::handle values, const char* separator) {
  std::string text;
  bool first = true;
  for (const py::handle value : values) {
    text += (first ? "" : separator) + text_of(option, value);
    first = false;
  }
  return text;
}

/// {"lamp": 2, "sun": (1, 1, 0)} is "lamp=2;sun=1,1,0".
std::string text_of_dictionary(const std::string& option, const py::dict& values) {
  std::string text;
  for (const auto& [name, value] : values) {
    if (!text.empty()) text += option == "sky" ? "," : ";";
    text += text_of(option, name) + "=" + text_of(option, value);
  }
  return text;
}

void read(const Option& option, py::handle value) {
  if (option.toggle) {
    *option.toggle = apps::parse_choice(option.name, text_of(option.name, value), apps::kOnOff);
    return;
  }
  if (option.list) {
    option.list->clear();
    if (!is_sequence(value)) option.list->push_back(text_of(option.name, value));
    if (is_sequence(value))
      for (const py::handle word : value) option.list->push_back(text_of(option.name, word));
    return;
  }
  const std::string text = text_of(option.name, value);
  if (text.empty()) throw BadOption({option.name, "", "", "a value or None"});
  option.read(text);
}

/// "spp" for "samples"; empty for words that are not known.
std::string keyword_of_other_tools(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  const std::string flag = apps::flag_of_other_tools("--" + name);
  return flag.starts_with("--") ? keyword_of(flag.substr(2, flag.find(' ') - 2)) : "";
}

/// The option of each keyword. Throws BadOption for other names.
std::vector<std::pair<const Option*, py::handle>> match(const std::vector<Option>& table,
                                                        const py::dict& keywords) {
  std::vector<std::pair<const Option*, py::handle>> matched;
  for (const auto& [key, value] : keywords) {
    const auto name = key.cast<std::string>();
    const auto found = std::find_if(table.begin(), table.end(), [&](const Option& option) {
      return !option.positional && keyword_of(option.name) == name;
    });
    if (found == table.end()) {
      std::vector<std::string> names;
      for (const Option& option : table) names.push_back(keyword_of(option.name));
      const std::string other = keyword_of_other_tools(name);
      throw BadOption({name, "", "is not an option", "one of gatelight.options()",
                       other.empty() ? did_you_mean(name, names) : fmt::format("; here it is '{}'", other)});
    }
    if (!value.is_none()) matched.emplace_back(&*found, value);
  }
  return matched;
}

}  // namespace

std::string text_of(const std::string& option, py::handle value) {
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "on" : "off";
  if (py::isinstance<py::dict>(value)) return text_of_dictionary(option, value.cast<py::dict>());
  if (PyIndex_Check(value.ptr()) != 0) return py::str(py::int_(value.attr("__index__")()));
  if (is_sequence(value))
    return joined(option, value, option == "size" ? "x" : option == "shutter" ? ":" : ",");
  if (py::hasattr(value, "__float__")) return py::repr(py::float_(value.attr("__float__")()));
  if (py::hasattr(value, "__fspath__")) return py::str(value.attr("__fspath__")());
  if (PyRange_Check(value.ptr())) {
    const auto step = value.attr("step").cast<int>();
    return fmt::format("{}:{}:{}", value.attr("start").cast<int>(),
                       value.attr("stop").cast<int>() - (step > 0 ? 1 : -1), step);
  }
  throw BadOption(
      {option, std::string(py::str(py::repr(value))), "", "a number, a word, a tuple or a dictionary"});
}

apps::RenderSettings read_keywords(const py::dict& keywords, apps::RenderSettings settings) {
  const std::vector<Option> table = apps::option_table(settings);
  const auto values = match(table, keywords);
  const auto read_all = [&] {
    for (const auto& [option, value] : values) {
      read(*option, value);
      settings.given.insert(option->name);
    }
  };
  read_all();
  if (settings.preset) {
    const auto apply = settings.frames.any() ? renderer::apply_preset_of_frames : renderer::apply_preset;
    apply(*settings.preset, settings.render);
    read_all();  // options beside a preset win
  }
  return settings;
}

void require_given(const apps::RenderSettings& settings, const std::function<bool(const Option&)>& fits,
                   const char* problem, std::string expected) {
  const std::set<std::string> known = apps::option_names(fits);
  if (expected.empty()) expected = "one of " + keyword_of(fmt::format("{}", fmt::join(known, ", ")));
  for (const std::string& name : settings.given)
    if (!known.contains(name)) throw BadOption({name, "", problem, expected});
}

void replace_keywords(py::dict& keywords, const py::dict& newer) {
  apps::RenderSettings settings;
  for (const Option& option : apps::option_table(settings)) {
    if (!newer.contains(keyword_of(option.name))) continue;
    for (const std::string& other : option.marks.excludes)
      keywords.attr("pop")(keyword_of(other), py::none());
  }
  for (const auto& [name, value] : newer) keywords[name] = value;
}

void add_options(py::module_& module) {
  module.def(
      "options",
      [] {
        apps::RenderSettings settings;
        py::dict all;
        for (const Option& option : apps::option_table(settings)) {
          if (option.positional) continue;
          py::dict entry;
          entry["help"] = option.help;
          entry["values"] = option.toggle ? "True|False" : option.unit;
          entry["default"] = option.toggle ? "False" : option.shown_default();
          entry["group"] = option.group;
          entry["common"] = option.marks.common;
          entry["loading"] = option.marks.stage == apps::OptionStage::load;
          all[py::str(keyword_of(option.name))] = entry;
        }
        return all;
      },
      "Every option by name: a dict with its help, values, default, group, whether it is common, and of "
      "loading.");
}

}  // namespace gatelight::python

#include "apps/settings/option.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gatelight::apps {
namespace {

struct Text {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(bool value) const { return name_of(kOnOff, value); }
  template <class Value>
  std::string operator()(const Value& value) const {
    return fmt::format("{}", value);
  }
  template <class Value>
  std::string operator()(const std::vector<Value>& values) const {
    return fmt::format("{}", fmt::join(values, ","));
  }
};

}  // namespace

std::string text_of(const OptionValue& value) {
  return std::visit(Text(), value);
}

Option any_word(const char* name, std::string& member, const char* unit, const char* help) {
  const auto value = [&member] { return member.empty() ? OptionValue() : member; };
  const auto read = [&member](const std::string& text) { member = text; };
  return {.name = name, .unit = unit, .help = help, .value = value, .read = read};
}

Option toggle(const char* name, bool& member, const char* help) {
  return {.name = name, .help = help, .value = [&member] { return member; }, .toggle = &member};
}

Option any_words(const char* name, std::vector<std::string>& member, const char* unit, const char* help) {
  return {.name = name, .unit = unit, .help = help, .value = [&member] { return member; }, .list = &member};
}

std::set<std::string> common_names(const std::vector<Option>& options) {
  std::set<std::string> names;
  for (const Option& option : options) {
    if (option.marks.common) names.insert(option.name);
  }
  return names;
}

}  // namespace gatelight::apps

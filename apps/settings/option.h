#pragma once
// The description of an option for the command line and recipes, bound to the member that it
// sets.

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "apps/settings/parsing.h"
#include "renderer/image/image_format.h"
#include "renderer/settings/options.h"

namespace gatelight::apps {

using renderer::Choice;
using renderer::Choices;
using renderer::enum_name;
using renderer::kEnumNames;
using renderer::name_of;
using renderer::RenderOptions;

/// The value of an option. std::monostate: none.
using OptionValue = std::variant<std::monostate, bool, std::int64_t, float, double, std::string,
                                 std::vector<int>, std::vector<float>, std::vector<std::string>>;

/// "on", "3", "0.1", "sobol", "1,2,3"; "" for nothing.
std::string text_of(const OptionValue& value);

enum class InRecipe : std::uint8_t {
  always,
  unless_reproducible,
  of_machine,  ///< unless reproducible; processes that make one picture may differ in it
  never,
};

/// A condition without which an option has no effect. The option is then refused, and left out of recipes.
struct Requirement {
  bool (*met)(const RenderOptions&);
  const char* expected;  ///< "`encoding` gate"
};

/// Where an option is used.
enum class OptionStage : std::uint8_t {
  load,     ///< decides which scene is loaded: the cells of a sweep have one value for all
  render,   ///< decides the picture
  output,   ///< decides how a finished picture is shown and written
  program,  ///< of the program's call, which the Python module does not have
};

/// Where an option is used, beside its flag of `render`.
struct Marks {
  bool common = false;      ///< the short help has it
  bool of_view = false;     ///< a member of --view-file, and a window changes it
  bool in_window = false;   ///< a window changes it while it is open
  bool in_sweep = true;     ///< false: files, the progress of one picture, limits that end it early
  bool of_cache = false;    ///< has no effect without a cache
  bool of_field = false;    ///< a cache without light transport (gatelight.Cache of Python) has it
  bool of_denoise = false;  ///< it finishes a picture that is there already
  OptionStage stage = OptionStage::render;
  InRecipe in_recipe = InRecipe::always;
  std::vector<Requirement> needs{};
  std::vector<std::string> excludes{};           ///< options that it replaces
  std::vector<renderer::ImageFormat> formats{};  ///< files that it changes; empty: all
};

struct Option {
  std::string name;  ///< of the flag, without its dashes
  std::string unit;  ///< placeholder of the value in the help; empty: the flag takes no value
  std::string help;
  std::function<OptionValue()> value;            ///< in recipes
  std::function<void(const std::string&)> read;  ///< throws BadOption
  std::function<std::string()> write;            ///< the text for read(), where it is not the value's
  bool* toggle = nullptr;                        ///< instead of read(): a flag without a value
  std::vector<std::string>* list = nullptr;      ///< instead of read(): the flag may be given several times

  // On the command line.
  std::string group = "Options";  ///< heading in the help; empty: it is not in the help
  std::string letter;             ///< "-o"
  std::string default_text;       ///< in the help, where it is not text()
  bool required = false;
  bool positional = false;
  int words = 1;  ///< values that a list takes each time

  Marks marks{};

  std::string flag() const { return "--" + name; }
  std::string text() const { return write ? write() : text_of(value()); }
  /// The default in the help; empty: it has none.
  std::string shown_default() const {
    if (toggle != nullptr || !default_text.empty()) return default_text;
    return value && list == nullptr ? text() : "";
  }
};

/// Options with a common heading in the help.
struct OptionGroup {
  std::vector<Option>& options;
  std::string name;

  Option& add(Option option, Marks marks = {}) {
    option.group = name;
    option.marks = std::move(marks);
    return options.emplace_back(std::move(option));
  }
};

/// The names of the options that the short help has.
std::set<std::string> common_names(const std::vector<Option>& options);

template <class Value>
OptionValue value_of(const Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    return enum_name(value);
  } else if constexpr (std::is_integral_v<Value> && !std::is_same_v<Value, bool>) {
    return static_cast<std::int64_t>(value);
  } else {
    return value;
  }
}

template <class Number>
using RangeOf = std::conditional_t<std::is_floating_point_v<Number>, RealRange, IntegerRange>;

template <class Number>
Number parse_number(const std::string& name, const std::string& text, const RangeOf<Number>& range) {
  if constexpr (std::is_same_v<Number, float>) {
    return parse_float(name, text, range);
  } else if constexpr (std::is_floating_point_v<Number>) {
    return parse_real(name, text, range);
  } else {
    return static_cast<Number>(parse_integer(name, text, range));
  }
}

template <class Number>
Option number(const std::string& name, Number& member, const RangeOf<Number>& range, const char* unit,
              const char* help) {
  const auto read = [&member, range, name](const std::string& text) {
    member = parse_number<Number>(name, text, range);
  };
  return {.name = name, .unit = unit, .help = help, .value = [&] { return value_of(member); }, .read = read};
}

/// A number, or the word `none` for no number. With an empty `none` there is no such word, and no number has
/// no text.
template <class Number>
Option number_or(const std::string& none, const std::string& name, std::optional<Number>& member,
                 const RangeOf<Number>& range, const std::string& unit, const char* help) {
  const auto value = [&member, none]() -> OptionValue {
    if (member) return value_of(*member);
    return none.empty() ? OptionValue() : none;
  };
  const auto read = [&member, range, none, name](const std::string& text) {
    member.reset();
    if (none.empty() || text != none) member = parse_number<Number>(name, text, range);
  };
  return {.name = name,
          .unit = none.empty() ? unit : unit + "|" + none,
          .help = help,
          .value = value,
          .read = read};
}

/// One of the names of a table.
template <class Member, class Table>
Option choice(const std::string& name, Member& member, const Table& table, const char* help) {
  const auto value = [&member, table]() -> OptionValue {
    if constexpr (std::is_integral_v<Member> && !std::is_same_v<Member, bool>) return value_of(member);
    return name_of(table, member);
  };
  const auto read = [&member, table, name](const std::string& text) {
    member = parse_choice(name, text, table);
  };
  return {.name = name, .unit = choice_names(table), .help = help, .value = value, .read = read};
}
template <class Enumeration>
Option choice(const std::string& name, Enumeration& member, const char* help) {
  return choice(name, member, Choices<Enumeration>(kEnumNames<Enumeration>), help);
}

/// A member with functions of its own. It has no value where `value` gives none. `read` returns the member of
/// the option's name and a text, or changes the member by them.
template <class Member, class Value, class Read>
Option read_by(const std::string& name, Member& member, const std::string& unit, const std::string& help,
               Value value, Read read) {
  const auto change = [&member, name, read](const std::string& text) {
    if constexpr (std::is_invocable_v<Read, Member&, const std::string&, const std::string&>) {
      read(member, name, text);
    } else {
      member = read(name, text);
    }
  };
  return {.name = name,
          .unit = unit,
          .help = help,
          .value = [&member, value]() -> OptionValue { return value(member); },
          .read = change};
}

/// Any word; an empty one counts as no value.
Option any_word(const char* name, std::string& member, const char* unit, const char* help);
/// A flag without a value.
Option toggle(const char* name, bool& member, const char* help);
/// Any word; the flag may be given several times.
Option any_words(const char* name, std::vector<std::string>& member, const char* unit, const char* help);

inline constexpr RealRange kNotNegative{0.0, 3.4e38};
inline constexpr Choice<bool> kOnOff[] = {{"on", true}, {"off", false}};

}  // namespace gatelight::apps

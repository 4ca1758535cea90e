#pragma once
// The description of an option for the command line, recipes and checkpoints, bound to the member that it
// sets.

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "renderer/settings/words.h"

namespace gatelight::renderer {

/// The value of an option. std::monostate: none.
using OptionValue = std::variant<std::monostate, bool, std::int64_t, float, double, std::string,
                                 std::vector<int>, std::vector<float>, std::vector<std::string>>;

/// "on", "3", "0.1", "sobol", "1,2,3"; "" for nothing.
std::string text_of(const OptionValue& value);

enum class InRecipe : std::uint8_t { always, unless_reproducible, never };

/// A condition without which an option has no effect. The option is then refused, and left out of recipes.
struct Need {
  bool (*met)(const RenderOptions&);
  const char* expected;  ///< "--encoding gate"
};

struct Option {
  std::string name;  ///< of the flag, without its dashes
  std::string unit;  ///< placeholder of the value in the help; empty: the flag takes no value
  std::string help;
  std::function<OptionValue()> value;            ///< in recipes
  std::function<void(const std::string&)> read;  ///< throws BadOption
  std::function<std::string()> write;            ///< what read() takes, where it is not the value's text
  bool* toggle = nullptr;                        ///< instead of read(): a flag without a value
  std::vector<std::string>* list = nullptr;      ///< instead of read(): the flag may be given several times

  // On the command line.
  std::string group = "Options";  ///< heading in the help; empty: it is not in the help
  std::string letter;             ///< "-o"
  std::string default_text;       ///< in the help, where it is not text()
  bool required = false;
  bool positional = false;
  int words = 1;          ///< values that a list takes each time
  bool of_cache = false;  ///< has no effect without a cache
  std::vector<Need> needs;

  // In files.
  InRecipe in_recipe = InRecipe::always;
  bool decides = true;                              ///< it decides the picture's bits: checkpoints store it
  std::function<std::string()> deciding;            ///< its text in checkpoints, where it is not text()
  std::string if_none;                              ///< its text in checkpoints without a value
  std::optional<neural::FeatureEncoding> encoding;  ///< it is stored for this encoding only

  std::string flag() const { return "--" + name; }
  /// Options without a flag exist for checkpoints only.
  bool has_flag() const { return read || toggle || list; }
  std::string text() const { return write ? write() : text_of(value()); }
};

/// Options with a common heading in the help.
struct OptionGroup {
  std::vector<Option>& options;
  std::string name;

  Option& add(Option option, std::vector<Need> needs = {}) {
    option.group = name;
    option.needs = std::move(needs);
    return options.emplace_back(std::move(option));
  }
};

inline Option decides_nothing(Option option, InRecipe in_recipe = InRecipe::always) {
  option.decides = false;
  option.in_recipe = in_recipe;
  return option;
}

template <class Value>
OptionValue value_of(const Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    return word(value);
  } else if constexpr (std::is_integral_v<Value> && !std::is_same_v<Value, bool>) {
    return static_cast<std::int64_t>(value);
  } else {
    return value;
  }
}

/// A member without a flag that decides bits.
template <class Member>
Option hidden(const char* name, const Member& member) {
  return {.name = name, .value = [&member] { return value_of(member); }, .in_recipe = InRecipe::never};
}

template <class Number>
using RangeOf = std::conditional_t<std::is_floating_point_v<Number>, RealRange, IntegerRange>;

template <class Number>
Number parse_number(const std::string& flag, const std::string& text, const RangeOf<Number>& range) {
  if constexpr (std::is_same_v<Number, float>) {
    return parse_float(flag, text, range);
  } else if constexpr (std::is_floating_point_v<Number>) {
    return parse_real(flag, text, range);
  } else {
    return static_cast<Number>(parse_integer(flag, text, range));
  }
}

template <class Number>
Option number(const std::string& name, Number& member, const RangeOf<Number>& range, const char* unit,
              const char* help) {
  const auto read = [&member, range, flag = "--" + name](const std::string& text) {
    member = parse_number<Number>(flag, text, range);
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
  const auto read = [&member, range, none, flag = "--" + name](const std::string& text) {
    member.reset();
    if (none.empty() || text != none) member = parse_number<Number>(flag, text, range);
  };
  return {.name = name,
          .unit = none.empty() ? unit : unit + "|" + none,
          .help = help,
          .value = value,
          .read = read};
}

/// One of the words of a table.
template <class Member, class Table>
Option choice(const std::string& name, Member& member, const Table& table, const char* help) {
  const auto value = [&member, table]() -> OptionValue {
    if constexpr (std::is_integral_v<Member> && !std::is_same_v<Member, bool>) return value_of(member);
    return name_of(table, member);
  };
  const auto read = [&member, table, flag = "--" + name](const std::string& text) {
    member = parse_choice(flag, text, table);
  };
  return {.name = name, .unit = choice_names(table), .help = help, .value = value, .read = read};
}
template <class Enumeration>
Option choice(const std::string& name, Enumeration& member, const char* help) {
  return choice(name, member, Choices<Enumeration>(kWords<Enumeration>), help);
}

/// Any word; an empty one counts as no value.
Option any_word(const char* name, std::string& member, const char* unit, const char* help);
/// A flag without a value.
Option toggle(const char* name, bool& member, const char* help);
/// Any word; the flag may be given several times.
Option any_words(const char* name, std::vector<std::string>& member, const char* unit, const char* help);

inline constexpr RealRange kNotNegative{0.0, 3.4e38};
inline constexpr Choice<bool> kOnOff[] = {{"on", true}, {"off", false}};

/// Moves the options named in `names` (separated by spaces) to the front, in that order.
void put_first(std::vector<Option>& options, const std::string& names);

}  // namespace gatelight::renderer

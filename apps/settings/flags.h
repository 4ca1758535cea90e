#pragma once
// Flags with ranges and words. The text is checked by values.h, so that every refusal reads the same.
// Includes CLI11, which takes seconds to compile: for the files that declare flags only.

#include <CLI/CLI.hpp>

#include <string>
#include <type_traits>
#include <utility>

#include "apps/settings/values.h"

namespace gatelight::apps {

/// A flag with one word that `read` checks and stores; `unit` stands for the word in the help.
template <typename Read>
CLI::Option* add_word(CLI::App& app, const std::string& flag, const std::string& unit,
                      const std::string& help, const std::string& default_text, Read read) {
  CLI::Option* option = app.add_option_function<std::string>(
      flag, [read = std::move(read)](const std::string& text) { read(text); }, help);
  option->type_name(unit);
  if (!default_text.empty()) option->default_str(default_text);
  return option;
}

template <typename Integer>
CLI::Option* add_integer(CLI::App& app, const std::string& flag, Integer& value, const IntegerRange& range,
                         const std::string& unit, const std::string& help) {
  return add_word(app, flag, unit, help, std::to_string(value),
                  [&value, flag, range](const std::string& text) {
                    value = static_cast<Integer>(parse_integer(flag, text, range));
                  });
}

/// default_text: how the help shows the default.
template <typename Real>
CLI::Option* add_real(CLI::App& app, const std::string& flag, Real& value, const RealRange& range,
                      const std::string& unit, const std::string& help, const std::string& default_text) {
  return add_word(app, flag, unit, help, default_text, [&value, flag, range](const std::string& text) {
    if constexpr (std::is_same_v<Real, float>) {
      value = parse_float(flag, text, range);
    } else {
      value = static_cast<Real>(parse_real(flag, text, range));
    }
  });
}

template <typename Value>
CLI::Option* add_choice(CLI::App& app, const std::string& flag, Value& value, Choices<Value> choices,
                        const std::string& help) {
  return add_word(
      app, flag, choice_names(choices), help, name_of(choices, value),
      [&value, flag, choices](const std::string& text) { value = parse_choice(flag, text, choices); });
}

}  // namespace gatelight::apps

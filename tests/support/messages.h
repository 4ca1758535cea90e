#pragma once
// Checks of an error or a warning: its type, one line, and the names and values in it; of an error about an
// option its parts.

#include <gtest/gtest.h>

#include <cctype>
#include <exception>
#include <string>
#include <string_view>
#include <typeinfo>
#include <vector>

#include "base/errors.h"

namespace gatelight::tests {

using NameList = std::vector<std::string>;

/// Where a check was called, as std::source_location, which clang has from version 16 on.
struct Place {
  const char* file;
  int line;

  static constexpr Place current(const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
    return {file, line};
  }
};

/// Whether the name is in the text as a word or number of its own: "4" is neither in "14" nor in "4.5".
inline bool has_name(std::string_view text, std::string_view name) {
  if (name.empty()) return false;
  const auto digit = [&](std::size_t i) {
    return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i]));
  };
  const auto goes_on = [&](std::size_t i) {
    return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) ||
                               (text[i] == '.' && digit(i - 1) && digit(i + 1)));
  };
  const bool word_begins = std::isalnum(static_cast<unsigned char>(name.front()));
  const bool word_ends = std::isalnum(static_cast<unsigned char>(name.back()));
  for (std::size_t at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
    if (!(word_begins && goes_on(at - 1)) && !(word_ends && goes_on(at + name.size()))) return true;
  }
  return false;
}

/// Expects one line that has all the names in it.
inline void expect_message(const std::string& message, const NameList& names,
                           Place place = Place::current()) {
  const ::testing::ScopedTrace trace(place.file, place.line, "message: " + message);
  EXPECT_NE(message, "") << "expected a message";
  EXPECT_EQ(message.find('\n'), std::string::npos) << "expected one line";
  for (const std::string& name : names) EXPECT_TRUE(has_name(message, name)) << "expected '" << name << "'";
}

/// Expects as many messages as lists of names, in this order.
inline void expect_messages(const std::vector<std::string>& messages, const std::vector<NameList>& names,
                            Place place = Place::current()) {
  const ::testing::ScopedTrace trace(place.file, place.line, "messages");
  ASSERT_EQ(messages.size(), names.size()) << ::testing::PrintToString(messages);
  for (std::size_t i = 0; i < names.size(); ++i) expect_message(messages[i], names[i], place);
}

/// The message of `act`, which throws exactly an `Error`; empty where it throws nothing.
template <typename Error, typename Act>
std::string refusal(const Act& act) {
  try {
    act();
  } catch (const std::exception& error) {
    EXPECT_STREQ(typeid(error).name(), typeid(Error).name()) << error.what();
    return error.what();
  }
  return "";
}

/// The parts of the error of `act`, which throws exactly an `Error`; empty where it throws nothing.
template <typename Error, typename Act>
ErrorParts refused_parts(const Act& act) {
  ErrorParts parts;
  refusal<Error>([&] {
    try {
      act();
    } catch (const gatelight::Error& error) {
      parts = error.parts();
      throw;
    }
  });
  return parts;
}

/// Expects this option and value, and these words in the problem and in what was expected.
inline void expect_parts(const ErrorParts& parts, const ErrorParts& wanted, Place place = Place::current()) {
  const ::testing::ScopedTrace trace(place.file, place.line, "error: " + sentence(parts));
  EXPECT_EQ(parts.option, wanted.option);
  EXPECT_EQ(parts.value, wanted.value);
  EXPECT_TRUE(wanted.problem.empty() || has_name(parts.problem, wanted.problem)) << wanted.problem;
  EXPECT_TRUE(wanted.expected.empty() || has_name(parts.expected, wanted.expected)) << wanted.expected;
  EXPECT_TRUE(wanted.hint.empty() || has_name(parts.hint, wanted.hint)) << wanted.hint;
}

template <typename Error, typename Act>
void expect_refused_parts(const Act& act, const ErrorParts& wanted, Place place = Place::current()) {
  expect_parts(refused_parts<Error>(act), wanted, place);
}

template <typename Error, typename Act>
void expect_refusal(const Act& act, const NameList& names, Place place = Place::current()) {
  const ::testing::ScopedTrace trace(place.file, place.line, "refusal");
  expect_message(refusal<Error>(act), names, place);
}

}  // namespace gatelight::tests

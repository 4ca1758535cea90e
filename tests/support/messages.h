#pragma once
// What a test asks of an error or a warning: its type, one line, and the names and values in it. The wording
// is recorded with the test's results; house.messages compares it with golden/messages.txt.

#include <gtest/gtest.h>

#include <cctype>
#include <exception>
#include <source_location>
#include <string>
#include <string_view>
#include <typeinfo>
#include <vector>

namespace gatelight::tests {

using NameList = std::vector<std::string>;
using Place = std::source_location;

/// Whether the name is in the text as a word of its own: "4" is not in "14".
inline bool has_name(std::string_view text, std::string_view name) {
  const auto joined = [](char a, char b) {
    return std::isalnum(static_cast<unsigned char>(a)) && std::isalnum(static_cast<unsigned char>(b));
  };
  for (std::size_t at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    const bool begins = at == 0 || !joined(text[at - 1], name.front());
    if (begins && (end == text.size() || !joined(name.back(), text[end]))) return true;
  }
  return false;
}

/// One line that has all the names in it. For texts of libraries and machines, whose wording is not ours.
inline void expect_names(const std::string& message, const NameList& names, Place place = Place::current()) {
  const ::testing::ScopedTrace trace(place.file_name(), static_cast<int>(place.line()),
                                     "message: " + message);
  EXPECT_NE(message, "") << "nothing was said";
  EXPECT_EQ(message.find('\n'), std::string::npos) << "expected one line";
  for (const std::string& name : names) EXPECT_TRUE(has_name(message, name)) << "expected '" << name << "'";
}

/// The same, and the wording is recorded.
inline void expect_message(const std::string& message, const NameList& names,
                           Place place = Place::current()) {
  expect_names(message, names, place);
  const ::testing::TestResult* result = ::testing::UnitTest::GetInstance()->current_test_info()->result();
  ::testing::Test::RecordProperty("message" + std::to_string(result->test_property_count()), message);
}

/// As many messages as lists of names, in this order.
inline void expect_messages(const std::vector<std::string>& messages, const std::vector<NameList>& names,
                            Place place = Place::current()) {
  const ::testing::ScopedTrace trace(place.file_name(), static_cast<int>(place.line()), "messages");
  ASSERT_EQ(messages.size(), names.size()) << ::testing::PrintToString(messages);
  for (std::size_t i = 0; i < names.size(); ++i) expect_message(messages[i], names[i], place);
}

/// What `act` says when it throws exactly an `Error`; empty where it throws nothing.
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

template <typename Error, typename Act>
void expect_refusal(const Act& act, const NameList& names, Place place = Place::current()) {
  const ::testing::ScopedTrace trace(place.file_name(), static_cast<int>(place.line()), "refusal");
  expect_message(refusal<Error>(act), names, place);
}

}  // namespace gatelight::tests

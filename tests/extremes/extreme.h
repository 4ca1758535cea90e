#pragma once
// What a test of the extremes tried and found, for the report of --gtest_output=json:FILE.

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace gatelight::testing {

/// Call it once at the end of each test. The columns: the subject; the values tried; what holds, with the
/// worst measured value and its bound; what is refused and how (exit code and line), "" for nothing. Numbers
/// have two significant digits.
inline void report_extreme(std::string_view subject, std::string_view range, std::string_view holds,
                           std::string_view refused) {
  ::testing::Test::RecordProperty("subject", std::string(subject));
  ::testing::Test::RecordProperty("range", std::string(range));
  ::testing::Test::RecordProperty("holds", std::string(holds));
  ::testing::Test::RecordProperty("refused", std::string(refused));
}

}  // namespace gatelight::testing

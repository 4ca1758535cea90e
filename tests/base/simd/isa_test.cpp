#include "base/simd/isa.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <string>

#include "base/errors.h"
#include "tests/support/messages.h"

namespace gatelight::simd {
namespace {

using tests::expect_message;
using tests::expect_refusal;

constexpr std::array<Isa, 2> kWithoutAvx512 = {Isa::scalar, Isa::avx2};

/// Sets GATELIGHT_ISA for the lifetime of the object.
class Variable {
 public:
  explicit Variable(const char* value) {
    if (const char* old = std::getenv("GATELIGHT_ISA")) old_ = old;
    ::setenv("GATELIGHT_ISA", value, 1);
  }
  ~Variable() {
    if (old_) {
      ::setenv("GATELIGHT_ISA", old_->c_str(), 1);
    } else {
      ::unsetenv("GATELIGHT_ISA");
    }
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  std::optional<std::string> old_;
};

TEST(Isa, ParsingInvertsNames) {
  for (const Isa isa : {Isa::scalar, Isa::avx2, Isa::avx512}) EXPECT_EQ(parse_isa(isa_name(isa)), isa);
  for (const char* word : {"", "AVX2", "avx", "avx5122", "auto"}) EXPECT_EQ(parse_isa(word), std::nullopt);
}

TEST(Isa, ScalarIsAlwaysAvailableAndFirst) {
  const std::vector<Isa> isas = available_isas();
  ASSERT_FALSE(isas.empty());
  EXPECT_EQ(isas.front(), Isa::scalar);
  EXPECT_TRUE(std::is_sorted(isas.begin(), isas.end()));
  EXPECT_EQ(std::adjacent_find(isas.begin(), isas.end()), isas.end());
}

TEST(Isa, TheFastestIsTakenUnlessForced) {
  EXPECT_EQ(choose_isa(std::nullopt, "", kWithoutAvx512), Isa::avx2);
  EXPECT_EQ(choose_isa(Isa::scalar, "", kWithoutAvx512), Isa::scalar);
  EXPECT_EQ(choose_isa(std::nullopt, "scalar", kWithoutAvx512), Isa::scalar);
  const Variable variable("");
  EXPECT_EQ(select_isa(), available_isas().back());
}

TEST(Isa, TheArgumentBeatsTheEnvironment) {
  EXPECT_EQ(choose_isa(Isa::avx2, "scalar", kWithoutAvx512), Isa::avx2);
  EXPECT_EQ(choose_isa(Isa::scalar, "avx512", kWithoutAvx512), Isa::scalar);
  const Variable variable("no-such-isa");
  EXPECT_EQ(select_isa(Isa::scalar), Isa::scalar);
}

TEST(Isa, TheEnvironmentIsRead) {
  for (const Isa isa : available_isas()) {
    const Variable variable(std::string(isa_name(isa)).c_str());
    EXPECT_EQ(select_isa(), isa);
  }
}

TEST(Isa, AMissingIsaIsRefusedWithTheAvailableOnes) {
  const std::string chosen = tests::refusal<Unavailable>([] { choose_isa(Isa::avx512, "", kWithoutAvx512); });
  expect_message(chosen, {"avx512", "scalar", "avx2"});
  EXPECT_FALSE(tests::has_name(chosen, "GATELIGHT_ISA"));
  expect_refusal<Unavailable>([] { choose_isa(std::nullopt, "avx512", kWithoutAvx512); },
                              {"GATELIGHT_ISA", "avx512", "scalar", "avx2"});
}

TEST(Isa, AnUnknownNameIsRefusedWithTheAvailableOnes) {
  const Variable variable("sse9");
  // The other instruction sets depend on the machine.
  tests::expect_message(tests::refusal<Unavailable>([] { select_isa(); }),
                        {"GATELIGHT_ISA", "sse9", "scalar"});
}

}  // namespace
}  // namespace gatelight::simd

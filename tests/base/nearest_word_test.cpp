#include "base/nearest_word.h"

#include <gtest/gtest.h>

namespace gatelight {
namespace {

const std::vector<std::string> kEnumNames = {"aperture", "spp", "size", "seed", "sobol"};

TEST(NearestWord, AThirdOfTheLettersMayDiffer) {
  EXPECT_EQ(nearest_word("aperure", kEnumNames), "aperture");
  EXPECT_EQ(nearest_word("apretures", kEnumNames), "aperture") << "a swap counts once";
  EXPECT_EQ(nearest_word("apxxture", kEnumNames), "aperture");
  EXPECT_EQ(nearest_word("apxxxure", kEnumNames), "") << "three of eight";
  EXPECT_EQ(nearest_word("fornt", {"front"}), "front");
  EXPECT_EQ(nearest_word("sppp", kEnumNames), "spp");
  EXPECT_EQ(nearest_word("SOBOL", kEnumNames), "sobol");
  EXPECT_EQ(nearest_word("frob", kEnumNames), "");
}

TEST(NearestWord, TheNearestOfSeveralIsOffered) {
  EXPECT_EQ(nearest_word("see", kEnumNames), "seed");
  EXPECT_EQ(nearest_word("seedlin", {"seedling", "seeding"}), "seedling");
  EXPECT_EQ(nearest_word("sees", {"seed", "seen"}), "seed") << "the first";
}

TEST(NearestWord, EmptyAndVeryLongWordsHaveNoNearestWord) {
  EXPECT_EQ(nearest_word("", kEnumNames), "");
  EXPECT_EQ(nearest_word("7", {"1", "", "2"}), "") << "no letter is right";
  EXPECT_EQ(nearest_word("seed", {}), "");
  EXPECT_EQ(nearest_word(std::string(100000, 'a'), {std::string(100000, 'a')}), "") << "too long to compare";
}

TEST(NearestWord, TheOfferEndsAMessage) {
  EXPECT_EQ(did_you_mean("aperure", kEnumNames), "; did you mean 'aperture'?");
  EXPECT_EQ(did_you_mean("frob", kEnumNames), "");
}

}  // namespace
}  // namespace gatelight

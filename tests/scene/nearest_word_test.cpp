#include "scene/nearest_word.h"

#include <gtest/gtest.h>

namespace gatelight::scene {
namespace {

const std::vector<std::string> kWords = {"aperture", "spp", "size", "seed", "sobol"};

TEST(NearestWord, AThirdOfTheLettersMayDiffer) {
  EXPECT_EQ(nearest_word("aperure", kWords), "aperture");
  EXPECT_EQ(nearest_word("apretures", kWords), "aperture") << "a swap counts once";
  EXPECT_EQ(nearest_word("apxxture", kWords), "aperture");
  EXPECT_EQ(nearest_word("apxxxure", kWords), "") << "three of eight";
  EXPECT_EQ(nearest_word("fornt", {"front"}), "front");
  EXPECT_EQ(nearest_word("sppp", kWords), "spp");
  EXPECT_EQ(nearest_word("SOBOL", kWords), "sobol");
  EXPECT_EQ(nearest_word("frob", kWords), "");
}

TEST(NearestWord, TheNearestOfSeveralIsOffered) {
  EXPECT_EQ(nearest_word("see", kWords), "seed");
  EXPECT_EQ(nearest_word("seedlin", {"seedling", "seeding"}), "seedling");
  EXPECT_EQ(nearest_word("sees", {"seed", "seen"}), "seed") << "the first";
}

TEST(NearestWord, NothingIsNearToNothing) {
  EXPECT_EQ(nearest_word("", kWords), "");
  EXPECT_EQ(nearest_word("7", {"1", "", "2"}), "") << "no letter is right";
  EXPECT_EQ(nearest_word("seed", {}), "");
  EXPECT_EQ(nearest_word(std::string(100000, 'a'), {std::string(100000, 'a')}), "") << "too long to compare";
}

TEST(NearestWord, TheOfferEndsAMessage) {
  EXPECT_EQ(did_you_mean("aperure", kWords), "; did you mean 'aperture'?");
  EXPECT_EQ(did_you_mean("frob", kWords), "");
}

}  // namespace
}  // namespace gatelight::scene

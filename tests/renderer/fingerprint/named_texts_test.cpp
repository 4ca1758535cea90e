#include "renderer/fingerprint/named_texts.h"

#include <gtest/gtest.h>

namespace gatelight::renderer {
namespace {

TEST(NamedTexts, DifferencesAreThoseUnderThePrefix) {
  Metadata metadata;
  const NamedTexts texts = {{"seed", "1"}, {"filter", "box"}};
  add_texts(metadata, "options", texts);
  EXPECT_EQ(metadata.at("options.seed"), "1");
  metadata["x"] = "shorter than the prefix";
  metadata["scene.seed"] = "2";
  EXPECT_EQ(list_differences(metadata, "options", texts), "");
  EXPECT_EQ(list_differences(metadata, "options", {{"seed", "3"}, {"filter", "box"}}),
            "seed: file 1, expected 3");
  EXPECT_EQ(list_differences(metadata, "options", {{"seed", "1"}}), "filter: file box, expected nothing");
  EXPECT_EQ(list_differences(metadata, "options", {{"filter", "box"}, {"seed", "1"}, {"size", "3x2"}}),
            "size: file nothing, expected 3x2");
}

}  // namespace
}  // namespace gatelight::renderer

// Pictures of the scenes in data/ against stored references, by statistics: tests/README.md explains how.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "tests/renderer/golden/golden_cases.h"
#include "tests/renderer/golden/golden_compare.h"
#include "tests/support/statistics.h"

namespace gatelight::testing {
namespace {

/// Writes the picture, its reference and the p-values, for debugging. Returns the names of the files.
std::string write_failure(const GoldenCase& c, const renderer::Picture& image,
                          const renderer::Picture& reference, const GoldenVerdict& verdict) {
  const std::filesystem::path folder = std::filesystem::path(GATELIGHT_BINARY_DIR) / "golden";
  std::filesystem::create_directories(folder);
  std::string names;
  const auto write = [&](const char* kind, const renderer::Picture& picture) {
    for (const char* extension : {".exr", ".png"}) {
      const std::filesystem::path file = folder / (c.name + "-" + kind + extension);
      renderer::write_image(picture, file, {.exr_float = true});
      names += "\n  " + file.string();
    }
  };
  write("image", image);
  write("reference", reference);
  write("p-value", p_value_picture(verdict, image.width, image.height));
  return names;
}

class ScenesGolden : public ::testing::TestWithParam<GoldenCase> {};

TEST_P(ScenesGolden, AgreesWithItsReference) {
  const GoldenCase& c = GetParam();
  const renderer::Picture reference = renderer::read_image(golden_reference(c));
  ASSERT_EQ(reference.metadata.at("scene"), golden_fingerprint(c))
      << "data/" << c.scene << ".glb has changed since its reference was made: run scripts/make-goldens "
      << c.name;
  const renderer::Picture image = render_golden(c, load_golden_scene(c), c.options);
  const int reference_spp = std::stoi(reference.metadata.at("spp"));
  const GoldenVerdict verdict = compare_with_reference({image, c.options.spp}, {reference, reference_spp},
                                                       sidak(1e-4, golden_cases().size()));
  EXPECT_TRUE(verdict.agrees) << c.name << " differs from its reference:\n"
                              << verdict.report << "See" << write_failure(c, image, reference, verdict);
}

INSTANTIATE_TEST_SUITE_P(All, ScenesGolden, ::testing::ValuesIn(golden_cases()), [](const auto& instance) {
  std::string name = instance.param.name;
  for (char& letter : name) letter = letter == '-' ? '_' : letter;
  return name;
});

}  // namespace
}  // namespace gatelight::testing

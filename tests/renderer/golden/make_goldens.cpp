// Renders the references of the golden pictures: scripts/make-goldens calls it.

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>

#include "renderer/image/image_write.h"
#include "tests/renderer/golden/golden_cases.h"

namespace gatelight::testing {
namespace {

/// Seed of the references; the tests have another.
constexpr std::uint32_t kSeed = 1;

void make(const GoldenCase& c) {
  const scene::Scene scene = load_golden_scene(c);
  renderer::RenderOptions options = c.options;
  options.spp = c.reference_spp;
  options.seed = kSeed;
  renderer::Picture picture = render_golden(c, scene, options);
  picture.metadata = {{"scene", golden_fingerprint(c)}, {"spp", std::to_string(c.reference_spp)}};
  const std::filesystem::path file = golden_reference(c);
  std::filesystem::create_directories(file.parent_path());
  renderer::write_image(picture, file, {.exr_float = true});
  std::cout << file.string() << ": " << std::filesystem::file_size(file) << " bytes" << std::endl;
}

}  // namespace
}  // namespace gatelight::testing

int main(int argc, char** argv) {
  try {
    if (argc < 2) {
      for (const auto& c : gatelight::testing::golden_cases()) gatelight::testing::make(c);
    }
    for (int i = 1; i < argc; ++i) gatelight::testing::make(gatelight::testing::golden_case(argv[i]));
  } catch (const std::exception& e) {
    std::cerr << "make-goldens: " << e.what() << '\n';
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}

// Missing libraries that are loaded on demand.

#include <unistd.h>

#include "renderer/image/image_write.h"
#include "tests/extremes/faults.h"

namespace gatelight::tests {
namespace {

class Libraries : public Faults {
 protected:
  /// Runs a copy of the program without the files beside it.
  Output run_alone(Words arguments) const {
    const std::string copy = path("bin/gatelight");
    std::filesystem::create_directory(folder / "bin");
    std::filesystem::copy_file(GATELIGHT_PROGRAM, copy, std::filesystem::copy_options::overwrite_existing);
    arguments.insert(arguments.begin(), copy);
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    return run_gatelight({}, [&] { ::execv(copy.c_str(), words.data()); });
  }
};

TEST_F(Libraries, MissingLibrariesAreReportedBeforeWorkThatRequiresThem) {
  const std::string hdr = folder.write("sky.hdr", "not even a picture");
  const std::string sky_png = path("sky.png");  // must be scaled
  renderer::Picture pixel{
      .width = 1, .height = 1, .layers = {{.channels = {"R", "G", "B"}, .values = {0, 0, 0}}}};
  renderer::write_image(pixel, sky_png);
  for (const Words& arguments :
       {std::vector<std::string>{"render", scene, "--environment", hdr, "-o", path("a.exr")},
        {"render", scene, "-o", path("a.tif")},
        {"render", scene, "-o", "hdr:-"},
        {"render", scene, "--background", sky_png, "-o", path("a.exr")},
        {"compare", hdr, hdr}}) {
    expect_failure(run_alone(arguments), 5,
                   {"cannot load OpenImageIO", "gatelight_openimageio.so", "gatelight-openimageio"});
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
  // Renders that do not need the library work.
  const std::string picture = path("a.png");
  expect_done(run_alone(square("-o {} --spp 1 --size 16x16 --quiet", {picture})));
  EXPECT_TRUE(std::filesystem::exists(picture));
}

}  // namespace
}  // namespace gatelight::tests

// The soft sky of frames, of the window and of single pictures.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "apps/settings/complete_settings.h"
#include "apps/view/view_session.h"
#include "tests/support/animated_file.h"
#include "tests/support/folder_test.h"
#include "tests/support/picture_files.h"
#include "tests/support/process.h"

namespace gatelight::tests {
namespace {

class FilmSky : public FolderTest {
 protected:
  /// A wall before the camera, and what glows for one second, brighter and brighter: a lamp behind the camera
  /// or a badge on the wall.
  void write(bool lamp) {
    scene::AnimatedFile file;
    file.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
    file.add("materials", {{"emissiveFactor", {0, 0, 0}}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
    for (const int material : {0, 1}) {
      nlohmann::json primitive = file.triangle();
      primitive["material"] = material;
      file.mesh(primitive);
    }
    file.node({{"mesh", 0}, {"scale", {8, 8, 1}}, {"translation", {-2, -2, 0}}});
    if (lamp) {
      file.node({{"mesh", 1}, {"scale", {3, 3, 1}}, {"translation", {-1, 1, 4}}, {"rotation", {1, 0, 0, 0}}});
    } else {
      file.node({{"mesh", 1}, {"scale", {0.3, 0.3, 1}}, {"translation", {0, 0, 0.01}}});
    }
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
    file.node({{"camera", 0}, {"translation", {0, 0, 3}}});
    file.root["extensionsUsed"] = {"KHR_animation_pointer"};
    file.move("/materials/1/emissiveFactor", {file.seconds({0, 1}), file.vectors({0, 0, 0, 1, 1, 1})});
    file.write(folder, "film.glb");
  }

  Output render(Words flags) const {
    flags.insert(flags.begin(),
                 {"render", path("film.glb"), "--size", "24x16", "--spp", "4", "--integrator", "path"});
    return expect_done(run_gatelight(flags));
  }

  float brightest(const std::string& file) const {
    const std::vector<float> values = beauty_of(path(file));
    return *std::max_element(values.begin(), values.end());
  }

  static int skies_in(const Output& output) {
    int count = 0;
    for (std::size_t at = 0; (at = output.err.find("soft sky", at)) != std::string::npos; ++at) ++count;
    return count;
  }
};

TEST_F(FilmSky, IsThatOfTheWholeFilmInAnyPartOfIt) {
  write(true);
  EXPECT_EQ(skies_in(render({"--frames", "0:2", "-o", path("a-%d.exr")})), 0);
  EXPECT_EQ(brightest("a-0.exr"), 0.0f) << "the lamp is not on yet";
  EXPECT_GT(brightest("a-2.exr"), 0.0f);
  EXPECT_EQ(skies_in(render({"--frames", "0", "-o", path("b-%d.exr")})), 0);
  EXPECT_EQ(brightest("b-0.exr"), 0.0f);
  EXPECT_EQ(skies_in(render({"--time", "0", "-o", path("still.exr")})), 1) << "a still has no other moment";
  write(false);
  EXPECT_EQ(skies_in(render({"--frames", "0:24:12", "-o", path("c-%d.exr")})), 1) << "one line for all";
  EXPECT_EQ(skies_in(render({"--frames", "24", "-o", path("d-%d.exr")})), 1);
  EXPECT_EQ(beauty_of(path("c-24.exr")), beauty_of(path("d-24.exr")));
}

TEST_F(FilmSky, OfTheWindowIsThatOfRender) {
  using namespace apps;
  write(false);
  const Words words = {"--preset=preview", "--size=48x32", "--spp=3", "--threads=2"};
  ViewSession session(path("film.glb"), words);
  // The badge fills the second view.
  for (const LiveFlags& flags :
       {LiveFlags{{"time", "1"}, {"eye", "0,0,3"}, {"target", "0,0,0"}},
        LiveFlags{{"time", "1"}, {"eye", "0.08,0.08,0.1"}, {"target", "0.08,0.08,0"}}}) {
    FlagChange change(flags.begin(), flags.end());
    const std::uint64_t revision = session.change("a", change, "");
    std::shared_ptr<const ShownPicture> shown;
    std::uint64_t version = 0;
    do {
      shown = session.wait("a", version, std::chrono::seconds(60));
      ASSERT_TRUE(shown);
      version = shown->version;
    } while (!shown->complete || shown->revision != revision);
    const RenderSettings settings = settings_of(path("film.glb"), words, flags);
    const scene::Scene scene = scene::load_gltf(path("film.glb"), settings.load);
    renderer::Renderer renderer(scene, settings.render);
    EXPECT_EQ(renderer.soft_sky(), flags.at("eye") == "0,0,3");
    EXPECT_EQ(shown->picture.layers.front().values, renderer.render().layers.front().values);
  }
}

}  // namespace
}  // namespace gatelight::tests

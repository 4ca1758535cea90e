#include "apps/view/picture_file.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/view/view_api.h"
#include "base/errors.h"
#include "renderer/image/image_write.h"
#include "tests/support/folder_test.h"

namespace gatelight::apps {
namespace {

using nlohmann::json;

class PictureFiles : public tests::FolderTest {
 protected:
  PictureFiles() {
    renderer::Picture picture{.width = 4, .height = 2};
    picture.layers.push_back({.channels = {"R", "G", "B"}, .values = std::vector<float>(24, 0.25f)});
    picture.layers.push_back(
        {.name = "depth", .channels = {"Z"}, .values = {0, 1, 2, 3, 4, 5, 6, 7}, .full_precision = true});
    picture.metadata["command"] = "gatelight render x.glb";
    renderer::write_image(picture, path("a.exr"));
  }
};

TEST_F(PictureFiles, AreShownWithTheirLayers) {
  PictureFile file(path("a.exr"), {"--exposure=0"});
  ViewApi api(file);
  const json scene = json::parse(api.answer({"GET", "api/scene", {}, ""}).body);
  EXPECT_EQ(scene["layers"],
            json::parse(R"([{"name": "", "label": "picture"}, {"name": "depth", "label": "depth"}])"));
  EXPECT_FALSE(scene.contains("cameras"));
  for (const char* layer : {"", "depth"}) {
    const WebResponse response = api.answer({"GET", "api/picture", {{"after", "0"}, {"layer", layer}}, ""});
    ASSERT_EQ(response.status, 200);
    EXPECT_EQ(json::parse(response.headers.at("X-Picture"))["layer"], layer);
  }
  const json pixel = json::parse(api.answer({"GET", "api/pixel", {{"x", "0.9"}, {"y", "0.9"}}, ""}).body);
  EXPECT_EQ(pixel["layers"]["depth"], json({7.0f}));
  EXPECT_EQ(json::parse(api.answer({"GET", "api/status", {}, ""}).body)["command"], "gatelight render x.glb");
}

TEST_F(PictureFiles, ChangeOnlyHowTheyAreShown) {
  PictureFile file(path("a.exr"), {"--exposure=0"});
  EXPECT_EQ(file.change("a", {{"exposure", "2"}}, ""), 2u);
  const auto shown = file.wait("a", 1, std::chrono::milliseconds(1000));
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->exposure, 2.0f);
  EXPECT_EQ(file.wait("b", 0, std::chrono::milliseconds(0))->exposure, 0.0f) << "another viewer";
  EXPECT_EQ(file.wait("a", 2, std::chrono::milliseconds(10)), nullptr);
  EXPECT_THROW(file.change("a", {{"eye", "1,2,3"}}, ""), BadOption);
  EXPECT_THROW(file.change("a", {{"exposure", "bright"}}, ""), BadOption);
  EXPECT_EQ(file.flags("a"), (LiveFlags{{"exposure", "2"}}));
}

TEST_F(PictureFiles, ThatCannotBeReadAreRefused) {
  EXPECT_THROW(PictureFile(path("no.exr"), {}), InputError);
}

}  // namespace
}  // namespace gatelight::apps

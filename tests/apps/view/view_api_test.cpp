#include "apps/view/view_api.h"
#include "apps/view/view_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace gatelight::apps {
namespace {

using nlohmann::json;

class Api : public ::testing::Test {
 protected:
  WebResponse get(const std::string& path, std::map<std::string, std::string> query = {}) {
    return api_.answer({"GET", path, std::move(query), ""});
  }
  WebResponse post(const std::string& body) { return api_.answer({"POST", "api/change", {}, body}); }
  /// Waits for the last picture.
  void finish() {
    std::string version = "0";
    while (!json::parse(get("api/status").body)["complete"].get<bool>()) {
      const WebResponse response = get("api/picture", {{"after", version}, {"layer", ""}});
      if (response.status == 200)
        version = std::to_string(json::parse(response.headers.at("X-Picture"))["version"].get<int>());
    }
  }

  ViewSession session_{GATELIGHT_SOURCE_DIR "/data/cornell-box.glb",
                       {"--preset=preview", "--size=40x24", "--spp=2", "--threads=2"}};
  ViewApi api_{session_};
};

TEST_F(Api, GivesThePage) {
  EXPECT_NE(get("").body.find("<script src=\"view.js\">"), std::string::npos);
  EXPECT_EQ(get("view.js").type, "text/javascript; charset=utf-8");
  EXPECT_EQ(get("view.css").status, 200);
  for (const char* path : {"view.html", "../view.js", "api", "api/", "etc/passwd", "view.js/"})
    EXPECT_EQ(get(path).status, 404) << path;
}

TEST_F(Api, DescribesTheScene) {
  const json scene = json::parse(get("api/scene").body);
  EXPECT_NE(scene["file"].get<std::string>().find("cornell-box"), std::string::npos);
  EXPECT_EQ(scene["given"]["size"], "40x24");
  EXPECT_FALSE(scene["glowing"].empty());
  EXPECT_GT(scene["radius"].get<float>(), 0.0f);
  EXPECT_EQ(scene["curves"].front(), "none");
  EXPECT_EQ(scene["layers"].front(), json::parse(R"({"name": "", "label": "picture"})"));
  for (const renderer::AovInfo& row : renderer::kAovs) {
    const auto shown = std::count_if(scene["layers"].begin(), scene["layers"].end(),
                                     [&](const json& layer) { return layer["name"] == row.name; });
    EXPECT_EQ(shown, row.label.empty() ? 0 : 1) << row.name;
  }
}

TEST_F(Api, GivesPicturesAndLayers) {
  finish();
  for (const char* layer : {"", "albedo", "normal", "depth", "instance"}) {
    const WebResponse response = get("api/picture", {{"after", "0"}, {"layer", layer}});
    ASSERT_EQ(response.status, 200) << layer;
    EXPECT_EQ(response.type, "image/png");
    EXPECT_EQ(response.body.substr(1, 3), "PNG");
    const json picture = json::parse(response.headers.at("X-Picture"));
    EXPECT_EQ(picture["width"], 40);
    EXPECT_EQ(picture["layer"], layer);
    EXPECT_EQ(picture["histogram"].size(), 192u);
    int sum = 0;
    for (const int count : picture["histogram"]) sum += count;
    EXPECT_EQ(sum, 3 * 40 * 24);
  }
  EXPECT_EQ(get("api/picture", {{"after", "-1"}}).status, 400);
  EXPECT_EQ(get("api/picture", {{"after", "x"}}).status, 400);
}

TEST_F(Api, TellsWhatIsUnderThePointer) {
  EXPECT_TRUE(json::parse(get("api/pixel", {{"x", "0.5"}, {"y", "0.5"}}).body).is_object());
  finish();
  const json pixel = json::parse(get("api/pixel", {{"x", "0.5"}, {"y", "0.5"}}).body);
  EXPECT_EQ(pixel["x"], 20);
  EXPECT_EQ(pixel["y"], 12);
  EXPECT_EQ(pixel["layers"]["radiance"].size(), 3u);
  EXPECT_FALSE(pixel["object"].get<std::string>().empty());
  EXPECT_EQ(pixel["position"].size(), 3u);
  EXPECT_GT(pixel["radius"].get<float>(), 0.0f);
  for (const char* x : {"-0.1", "1.1", "nan", "", "1e999"})
    EXPECT_EQ(get("api/pixel", {{"x", x}, {"y", "0.5"}}).status, 400) << x;
}

TEST_F(Api, ChangesFlags) {
  EXPECT_EQ(json::parse(post(R"({"flags": {"exposure": "2"}})").body)["revision"], 2);
  EXPECT_NE(json::parse(get("api/status").body)["command"].get<std::string>().find("--exposure=2"),
            std::string::npos);
  EXPECT_EQ(json::parse(get("api/scene").body)["flags"]["exposure"], "2");
  EXPECT_EQ(post(R"({"flags": {"exposure": null}})").status, 200);
  EXPECT_EQ(json::parse(get("api/scene").body)["flags"].size(), 0u);
}

TEST_F(Api, SaysWhatIsWrongWithARequest) {
  for (const char* body : {"", "{", "[]", "3", "null", R"({"flags": 3})", R"({"flags": {"exposure": 3}})",
                           R"({"flags": {"exposure": "x"}})", R"({"flags": {"output": "x.exr"}})",
                           R"({"flags": {"exposure": ["1"]}})", R"({"layer": 3})", "\xff\xfe"}) {
    const WebResponse response = post(body);
    EXPECT_EQ(response.status, 400) << body;
    EXPECT_FALSE(json::parse(response.body)["error"].get<std::string>().empty());
  }
  EXPECT_EQ(get("api/status", {{"viewer", "../x"}}).status, 400);
  EXPECT_EQ(get("api/status", {{"viewer", std::string(41, 'a')}}).status, 400);
  EXPECT_EQ(get("api/save", {{"format", "exe"}}).status, 400);
  EXPECT_EQ(get("api/change").status, 404);
  EXPECT_EQ(api_.answer({"POST", "api/status", {}, "{}"}).status, 404);
}

TEST_F(Api, SavesTheLastWholePicture) {
  finish();
  const WebResponse exr = get("api/save", {{"format", "exr"}}), png = get("api/save", {{"format", "png"}});
  EXPECT_EQ(exr.body.substr(0, 4), "\x76\x2f\x31\x01");
  EXPECT_NE(exr.body.find("--preset=preview"), std::string::npos) << "the recipe";
  EXPECT_EQ(png.body.substr(1, 3), "PNG");
  EXPECT_EQ(exr.headers.at("Content-Disposition"), "attachment; filename=gatelight.exr");
}

}  // namespace
}  // namespace gatelight::apps

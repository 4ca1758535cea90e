#include "apps/sweep/report.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <regex>

#include "apps/sweep/page.h"
#include "apps/sweep/picture_uri.h"
#include "renderer/image_write.h"
#include "tests/temporary_folder.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using tests::TemporaryFolder;

constexpr const char* kJpeg = "data:image/jpeg;base64,";

std::string decode_base64(const std::string& text) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(kDigits.find(c));
    count += 6;
    if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
  }
  return bytes;
}

struct Decoded {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> bytes;
};

Decoded decode(const std::string& uri) {
  EXPECT_THAT(uri, StartsWith(kJpeg));
  const std::string jpeg = decode_base64(uri.substr(std::string(kJpeg).size()));
  OIIO::Filesystem::IOMemReader memory(jpeg.data(), jpeg.size());
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open("memory.jpg", nullptr, &memory);
  if (!input) {
    ADD_FAILURE() << OIIO::geterror();
    return {};
  }
  Decoded decoded{input->spec().width, input->spec().height, {}};
  decoded.bytes.resize(3 * static_cast<std::size_t>(decoded.width) *
                       static_cast<std::size_t>(decoded.height));
  EXPECT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, decoded.bytes.data()));
  return decoded;
}

renderer::Picture flat_picture(int width, int height, std::array<float, 3> color) {
  renderer::Picture picture{.width = width, .height = height};
  renderer::Layer beauty{.channels = {"R", "G", "B"}};
  for (int i = 0; i < width * height; ++i)
    beauty.values.insert(beauty.values.end(), color.begin(), color.end());
  picture.layers.push_back(std::move(beauty));
  return picture;
}

/// The JSON in the page's element of this id.
ordered_json data_of(const std::string& page, const std::string& id) {
  const std::string open = "<script type=\"application/json\" id=\"" + id + "\">";
  const std::size_t from = page.find(open);
  if (from == std::string::npos) return nullptr;
  const std::size_t start = from + open.size();
  return ordered_json::parse(page.substr(start, page.find("</script>", start) - start));
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

ordered_json one_cell(const ordered_json& changes = ordered_json::object()) {
  ordered_json cell = {{"id", "1"},
                       {"scene", "room"},
                       {"series", "nrc"},
                       {"status", "done"},
                       {"reference", "path"},
                       {"picture", "pictures/1.png"},
                       {"error_map", nullptr},
                       {"options", {{"exposure", 1.0}, {"tonemap", "filmic"}}}};
  cell.update(changes);
  return {
      {"schema", 1},
      {"scenes", {{{"name", "room"}, {"references", {{{"kind", "path"}, {"file", "references/r.exr"}}}}}}},
      {"cells", {cell}}};
}

TEST(ReportPage, JsonCannotEndItsScriptAndReadsTheSame) {
  const ordered_json json = {{"</script><script>", "<!-- \xe2\x80\xa8 \xc3\xa4 & \\ \" \n"},
                             {"none", nullptr}};
  const std::string text = json_for_script(json);
  EXPECT_EQ(text.find('<'), std::string::npos);
  for (const char c : text) EXPECT_TRUE(c >= ' ' && c <= '~') << static_cast<int>(c);
  EXPECT_EQ(ordered_json::parse(text), json);
}

TEST(ReportPage, WhatJsonCannotSayIsNullOrReplaced) {
  EXPECT_EQ(json_for_script({{"x", std::numeric_limits<double>::infinity()}}), R"({"x":null})");
  EXPECT_EQ(json_for_script({{"x", std::numeric_limits<double>::quiet_NaN()}}), R"({"x":null})");
  EXPECT_EQ(json_for_script("\xff"), R"("\ufffd")");
}

TEST(ReportPage, SlotsAreFilledOnceAndInPlace) {
  EXPECT_EQ(fill_slots("a {{x}} b {{y}}{{x}}", {{"x", "{{y}}"}, {"y", "$1"}}), "a {{y}} b $1{{y}}");
  EXPECT_EQ(fill_slots("{ } none", {}), "{ } none");
}

TEST(ReportPage, HoldsItsScriptsAndTheLicenceOfChartJs) {
  const std::string page = make_page(one_cell(), ordered_json::object());
  EXPECT_THAT(page, StartsWith("<!doctype html>"));
  EXPECT_THAT(page, HasSubstr("Chart.js v"));
  EXPECT_THAT(page, HasSubstr("Released under the MIT License"));
  EXPECT_THAT(page, HasSubstr("function frontOf("));
  EXPECT_THAT(page, HasSubstr("--series-1:"));
  EXPECT_THAT(page, Not(HasSubstr("{{script}}")));
  // Each element is ended by its own end alone.
  EXPECT_EQ(count(page, "<script"), 4u);
  EXPECT_EQ(count(page, "</script>"), 4u);
  EXPECT_EQ(count(page, "</style>"), 1u);
}

TEST(ReportPage, AsksForNothingOutside) {
  const std::string page = make_page(one_cell(), ordered_json::object());
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  const std::regex loads(R"re((src|href)\s*=\s*["'](?!data:)|@import|url\(\s*["']?https?:)re");
  std::smatch found;
  EXPECT_FALSE(std::regex_search(page, found, loads)) << found.str();
}

TEST(ReportPicture, KeepsSizeAndColourOfWhatThePngShows) {
  const Decoded small = decode(picture_uri(flat_picture(64, 40, {0.5f, 0.1f, 0.02f}), {}));
  EXPECT_EQ(small.width, 64);
  EXPECT_EQ(small.height, 40);
  const renderer::ImageWriteOptions display{.exposure = 1.0f, .tonemap = renderer::Tonemap::filmic};
  const Decoded shown = decode(picture_uri(flat_picture(16, 16, {0.5f, 0.1f, 0.02f}), display));
  for (std::size_t c = 0; c < 3; ++c) {
    const float value = std::array{0.5f, 0.1f, 0.02f}[c];
    EXPECT_NEAR(small.bytes[c], renderer::display_byte(value, 1.0f, renderer::Tonemap::none), 2);
    EXPECT_NEAR(shown.bytes[c], renderer::display_byte(value, 2.0f, renderer::Tonemap::filmic), 2);
  }
}

TEST(ReportPicture, WidePicturesShrinkByMeansOfLight) {
  renderer::Picture stripes = flat_picture(2 * kMaxPictureWidth, 30, {0.0f, 0.0f, 0.0f});
  std::vector<float>& values = stripes.layers.front().values;
  for (std::size_t i = 0; i < values.size(); i += 6)
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(i), 3, 1.0f);
  const Decoded decoded = decode(picture_uri(stripes, {}));
  EXPECT_EQ(decoded.width, kMaxPictureWidth);
  EXPECT_EQ(decoded.height, 15);
  // Half the light is byte 188; half the byte would be 128.
  EXPECT_NEAR(decoded.bytes[3 * (7 * kMaxPictureWidth + 640)], 188, 3);
}

TEST(Report, EmbedsPicturesMapsAndReferencesByTheirNames) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "pictures");
  std::filesystem::create_directories(folder / "references");
  renderer::write_image(flat_picture(8, 8, {0.5f, 0.5f, 0.5f}), folder / "pictures/1.png");
  renderer::write_image(flat_picture(8, 8, {0.0f, 1.0f, 0.0f}), folder / "pictures/1-flip.png");
  renderer::write_image(flat_picture(8, 8, {0.25f, 0.25f, 0.25f}), folder / "references/r.exr");
  const ordered_json results = one_cell({{"error_map", "pictures/1-flip.png"}});
  const std::string page = make_report(results, folder.path().string());
  EXPECT_EQ(data_of(page, "results"), results);
  const ordered_json pictures = data_of(page, "pictures");
  ASSERT_EQ(pictures.size(), 3u);
  EXPECT_NEAR(decode(pictures["pictures/1.png"]).bytes[0], 188, 2);
  EXPECT_NEAR(decode(pictures["pictures/1-flip.png"]).bytes[1], 255, 2);
  // Shown as the cells' PNGs were made: a stop brighter, with the curve.
  EXPECT_NEAR(decode(pictures["references/r.exr"]).bytes[0],
              renderer::display_byte(0.5f, 1.0f, renderer::Tonemap::filmic), 2);
}

TEST(Report, LeavesOutPicturesThatCannotBeRead) {
  const TemporaryFolder folder;
  folder.write("pictures/1.png", "no picture");
  const std::string page = make_report(one_cell({{"error_map", "pictures/1.txt"}}), folder.path().string());
  EXPECT_TRUE(data_of(page, "pictures").empty());
}

TEST(Report, EveryNumberMayBeMissing) {
  const TemporaryFolder folder;
  const ordered_json failed =
      one_cell({{"status", "failed"}, {"picture", nullptr}, {"options", nullptr}, {"errors", nullptr}});
  EXPECT_EQ(data_of(make_report(failed, folder.path().string()), "results"), failed);
  for (const char* text : {R"({"scenes":[],"cells":[]})", R"({"schema":1})",
                           R"({"scenes":[{"name":"x"}],"cells":[{}]})", R"({"scenes":null,"cells":null})"}) {
    EXPECT_TRUE(data_of(make_report(ordered_json::parse(text), folder.path().string()), "pictures").empty())
        << text;
  }
}

}  // namespace
}  // namespace gatelight::apps

#include "apps/sweep/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <regex>

#include "apps/sweep/page.h"
#include "apps/sweep/picture_uri.h"
#include "base/image/jpeg_read.h"
#include "renderer/image/image_write.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
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
  JpegReader reader({jpeg.begin(), jpeg.end()});
  return {reader.width(), reader.height(), reader.read_8()};
}

renderer::Picture flat_picture(int width, int height, std::array<float, 3> color) {
  renderer::Picture picture{.width = width, .height = height};
  renderer::Layer beauty{.channels = {"R", "G", "B"}};
  for (int i = 0; i < width * height; ++i)
    beauty.values.insert(beauty.values.end(), color.begin(), color.end());
  picture.layers.push_back(std::move(beauty));
  return picture;
}

/// Content of the page's script with this id.
std::string text_of(const std::string& page, const std::string& id) {
  const std::string open = "\" id=\"" + id + "\">";
  const std::size_t from = page.find(open);
  if (from == std::string::npos) return "null";
  const std::size_t start = from + open.size();
  return page.substr(start, page.find("</script>", start) - start);
}

ordered_json data_of(const std::string& page, const std::string& id) {
  return ordered_json::parse(text_of(page, id));
}

std::string uri_of(const std::string& page, const std::string& file) {
  for (const ordered_json& entry : data_of(page, "pictures")) {
    if (entry["file"] == file) return text_of(page, entry["element"]);
  }
  return "";
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
  const ordered_json hostile = {{"</script><script>", "<!-- \xe2\x80\xa8 \xc3\xa4 & \\ \" \n"},
                                {"none", nullptr}};
  const std::string text = json_for_script(hostile);
  EXPECT_EQ(text.find('<'), std::string::npos);
  for (const char c : text) EXPECT_TRUE(c >= ' ' && c <= '~') << static_cast<int>(c);
  EXPECT_EQ(ordered_json::parse(text), hostile);
}

TEST(ReportPage, ValuesThatJsonCannotStoreAreNullOrReplaced) {
  EXPECT_EQ(json_for_script({{"x", std::numeric_limits<double>::infinity()}}), R"({"x":null})");
  EXPECT_EQ(json_for_script({{"x", std::numeric_limits<double>::quiet_NaN()}}), R"({"x":null})");
  EXPECT_EQ(json_for_script("\xff"), R"("\ufffd")");
}

TEST(ReportPage, SlotsAreFilledOnceAndInPlace) {
  EXPECT_EQ(fill_slots("a {{x}} b {{y}}{{x}}", {{"x", "{{y}}"}, {"y", "$1"}}), "a {{y}} b $1{{y}}");
  EXPECT_EQ(fill_slots("{ } none", {}), "{ } none");
}

TEST(ReportPage, HoldsItsScriptsAndTheLicenceOfChartJs) {
  const std::string page = make_page(one_cell(), {});
  EXPECT_THAT(page, StartsWith("<!doctype html>"));
  // A build without Chart.js has neither.
  EXPECT_EQ(count(page, "Chart.js v") > 0, bool{GATELIGHT_CHARTS});
  EXPECT_EQ(count(page, "Released under the MIT License") > 0, bool{GATELIGHT_CHARTS});
  EXPECT_THAT(page, HasSubstr("function frontOf("));
  EXPECT_THAT(page, HasSubstr("--series-1:"));
  EXPECT_THAT(page, Not(HasSubstr("{{script}}")));
  // Only its own end tag ends each element.
  EXPECT_EQ(count(page, "<script"), 4u);
  EXPECT_EQ(count(page, "</script>"), 4u);
  EXPECT_EQ(count(page, "</style>"), 1u);
}

TEST(ReportPage, LoadsNothingFromOutside) {
  const std::string page = make_page(one_cell(), {});
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  const std::regex loads(R"re((src|href)\s*=\s*["'](?!data:)|@import|url\(\s*["']?https?:)re");
  std::smatch found;
  EXPECT_FALSE(std::regex_search(page, found, loads)) << found.str();
}

TEST(ReportPicture, KeepsSizeAndColourOfThePng) {
  const Decoded small = decode(embed_picture(flat_picture(64, 40, {0.5f, 0.1f, 0.02f}), {}).uri);
  EXPECT_EQ(small.width, 64);
  EXPECT_EQ(small.height, 40);
  const renderer::ImageWriteOptions display{
      .display = {.exposure = 1.0f, .tonemap = renderer::Tonemap::filmic}};
  const Decoded shown = decode(embed_picture(flat_picture(16, 16, {0.5f, 0.1f, 0.02f}), display).uri);
  for (std::size_t c = 0; c < 3; ++c) {
    const float value = std::array{0.5f, 0.1f, 0.02f}[c];
    EXPECT_NEAR(small.bytes[c], renderer::display_byte(value, 1.0f, renderer::Tonemap::none), 2);
    EXPECT_NEAR(shown.bytes[c], renderer::display_byte(value, 2.0f, renderer::Tonemap::filmic), 2);
  }
}

/// Black and white, one pixel each.
renderer::Picture striped_picture(int width, int height) {
  renderer::Picture stripes = flat_picture(width, height, {0.0f, 0.0f, 0.0f});
  std::vector<float>& values = stripes.layers.front().values;
  for (std::size_t i = 0; i < values.size(); i += 6)
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(i), 3, 1.0f);
  return stripes;
}

TEST(ReportPicture, WidePicturesShrinkByMeansOfLight) {
  const EmbeddedPicture picture = embed_picture(striped_picture(2 * kMaxPictureWidth, 30), {});
  EXPECT_EQ(picture.size, (std::array{2 * kMaxPictureWidth, 30}));
  EXPECT_EQ(picture.width, kMaxPictureWidth);
  const Decoded decoded = decode(picture.uri);
  EXPECT_EQ(decoded.width, kMaxPictureWidth);
  EXPECT_EQ(decoded.height, 15);
  // Half the light is byte 188; half the byte would be 128.
  EXPECT_NEAR(decoded.bytes[3 * (7 * kMaxPictureWidth + 640)], 188, 3);
}

TEST(ReportPicture, MapsShrinkByMeansOfBytesAndAreSmaller) {
  const renderer::Picture stripes = striped_picture(1280, 32);
  const Decoded map = decode(embed_picture(stripes, {}, PictureKind::map, 640).uri);
  EXPECT_EQ(map.width, 640);
  EXPECT_NEAR(map.bytes[3 * (8 * 640 + 320)], 128, 3);
  renderer::Picture colors = flat_picture(256, 256, {0.0f, 0.0f, 0.0f});
  std::vector<float>& values = colors.layers.front().values;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i * 7919 % 101) / 100.0f;
  EXPECT_LT(embed_picture(colors, {}, PictureKind::map).uri.size(),
            embed_picture(colors, {}, PictureKind::light).uri.size() * 6 / 10);
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
  ASSERT_EQ(data_of(page, "pictures").size(), 3u);
  EXPECT_NEAR(decode(uri_of(page, "pictures/1.png")).bytes[0], 188, 2);
  EXPECT_NEAR(decode(uri_of(page, "pictures/1-flip.png")).bytes[1], 255, 3);
  // Shown as the cells' PNGs were made: a stop brighter, with the curve.
  EXPECT_NEAR(decode(uri_of(page, "references/r.exr")).bytes[0],
              renderer::display_byte(0.5f, 1.0f, renderer::Tonemap::filmic), 2);
}

TEST(Report, ShowsAReferenceWithTheExposureOfEachPictureBesideIt) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "references");
  renderer::write_image(flat_picture(8, 8, {0.1f, 0.1f, 0.1f}), folder / "references/r.exr");
  ordered_json results = one_cell();
  results["cells"][0]["options"]["tonemap"] = "none";
  results["cells"].push_back(results["cells"][0]);
  results["cells"][1]["picture"] = "pictures/2.png";
  results["cells"][1]["options"]["exposure"] = 2.0;
  // A cell without a picture needs no reference.
  results["cells"].push_back(results["cells"][0]);
  results["cells"][2]["picture"] = nullptr;
  results["cells"][2]["options"]["exposure"] = 3.0;
  const std::string page = make_report(results, folder.path().string());
  const ordered_json index = data_of(page, "pictures");
  ASSERT_EQ(index.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(index[i]["file"], "references/r.exr");
    EXPECT_EQ(index[i]["exposure"], results["cells"][i]["options"]["exposure"]);
    EXPECT_EQ(index[i]["tonemap"], "none");
    EXPECT_NEAR(decode(text_of(page, index[i]["element"])).bytes[0],
                renderer::display_byte(i == 0 ? 0.2f : 0.4f, 1.0f, renderer::Tonemap::none), 2);
  }
}

TEST(Report, EmbedsOnlyReferencesThatACellNames) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "references");
  ordered_json results = one_cell({{"reference_id", "b"}});
  results["scenes"][0]["references"] = ordered_json::array();
  for (const std::string id : {"a", "b"}) {
    renderer::write_image(flat_picture(8, 8, {0.1f, 0.1f, 0.1f}), folder / ("references/" + id + ".exr"));
    results["scenes"][0]["references"].push_back(
        {{"id", id}, {"kind", "path"}, {"file", "references/" + id + ".exr"}});
  }
  const auto files = [&] {
    std::vector<std::string> names;
    for (const ordered_json& entry : data_of(make_report(results, folder.path().string()), "pictures"))
      names.push_back(entry["file"]);
    return names;
  };
  EXPECT_THAT(files(), ::testing::ElementsAre("references/b.exr"));
  results["cells"][0].erase("reference_id");
  EXPECT_THAT(files(), ::testing::ElementsAre("references/a.exr", "references/b.exr"));
}

TEST(Report, AnAbsolutePathIsTakenAsItIs) {
  const TemporaryFolder folder;
  const TemporaryFolder other;
  renderer::write_image(flat_picture(8, 8, {1.0f, 1.0f, 1.0f}), other / "r.exr");
  renderer::write_image(flat_picture(8, 8, {0.0f, 0.0f, 0.0f}), folder / "r.exr");
  ordered_json results = one_cell({{"options", nullptr}});
  for (const auto& [file, byte] : {std::pair{(other / "r.exr").string(), 255}, {std::string("r.exr"), 0}}) {
    results["scenes"][0]["references"][0]["file"] = file;
    EXPECT_EQ(decode(uri_of(make_report(results, folder.path().string()), file)).bytes[0], byte);
  }
}

TEST(Report, ManyPicturesAreSmaller) {
  const TemporaryFolder folder;
  const renderer::Picture wide = flat_picture(1300, 4, {0.5f, 0.5f, 0.5f});
  renderer::write_image(wide, folder / "1.png");
  ordered_json results = one_cell();
  const auto widths = [&](int count) {
    results["cells"].clear();
    for (int i = 0; i < count / 2; ++i) {
      ordered_json cell = {{"picture", std::to_string(i) + "/../1.png"},
                           {"error_map", std::to_string(i) + "/.././1.png"}};
      std::filesystem::create_directories(folder / std::to_string(i));
      results["cells"].push_back(cell);
    }
    const ordered_json index = data_of(make_report(results, folder.path().string()), "pictures");
    EXPECT_EQ(index.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(index[0]["size"], ordered_json({1300, 4}));
    return std::pair(index[0]["width"].get<int>(), index[1]["width"].get<int>());
  };
  EXPECT_EQ(widths(60), std::pair(1280, 960));
  EXPECT_EQ(widths(240), std::pair(640, 480));
  EXPECT_EQ(widths(428), std::pair(480, 360));
}

TEST(Report, StatesItsSize) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "pictures");
  renderer::write_image(flat_picture(64, 64, {0.5f, 0.5f, 0.5f}), folder / "pictures/1.png");
  const std::string page = make_report(one_cell(), folder.path().string());
  std::smatch found;
  ASSERT_TRUE(std::regex_search(page, found, std::regex("<body data-bytes=\"([0-9]+)\">")));
  EXPECT_NEAR(std::stod(found[1]), static_cast<double>(page.size()), 100.0);
  EXPECT_EQ(data_of(page, "pictures")[0]["bytes"], uri_of(page, "pictures/1.png").size());
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

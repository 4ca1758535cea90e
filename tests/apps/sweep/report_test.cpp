// The page of a sweep: its texts, numbers, charts and pictures.

#include "apps/sweep/report.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "apps/sweep/picture_uri.h"
#include "apps/sweep/report_chart.h"
#include "apps/sweep/results.h"
#include "base/image/jpeg_read.h"
#include "renderer/image/image_write.h"
#include "tests/apps/sweep/sweep_records.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using tests::TemporaryFolder;

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
  const std::string begin = "data:image/jpeg;base64,";
  EXPECT_THAT(uri, StartsWith(begin));
  const std::string jpeg = decode_base64(uri.substr(begin.size()));
  JpegReader reader({jpeg.begin(), jpeg.end()});
  return {reader.width(), reader.height(), reader.read_8()};
}

renderer::Picture grey_picture(int width, int height, float value) {
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3;
  renderer::Picture picture{.width = width, .height = height};
  picture.layers.push_back({.channels = {"R", "G", "B"}, .values = std::vector<float>(count, value)});
  return picture;
}

int byte_of(float radiance, float scale = 1.0f, renderer::Tonemap tonemap = renderer::Tonemap::none) {
  return renderer::display_byte(radiance, scale, tonemap);
}

/// All matches of the first group.
std::vector<std::string> found(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> all;
  for (std::sregex_iterator at(text.begin(), text.end(), regex); at != std::sregex_iterator(); ++at)
    all.push_back((*at)[1]);
  return all;
}

/// Two runs of two seeds: one cell is done, another one has failed, and of the second run one is missing.
ordered_json results() {
  SceneResults scene;
  scene.scene = {{"name", small_plan().scenes[0].name},
                 {"file", "a.glb"},
                 {"references",
                  {{{"id", "ref"},
                    {"kind", "path"},
                    {"spp", 64},
                    {"file", "references/ref.exr"},
                    {"rel_mse_noise", 0.005},
                    {"seconds", 12.0}}}}};
  scene.cells = {done(cached("1", 4)), done(cached("2")), failed_record(cached("3", 4, 2), "it <broke>")};
  scene.cells[0]["errors"]["flip"] = 0.123456789;
  return make_results({"gatelight", "sweep"}, {scene});
}

std::string page_of(const ordered_json& results) {
  const TemporaryFolder folder;
  return make_report(results, folder.path().string());
}

/// The table of all pictures, its head first.
std::vector<std::vector<std::string>> rows_of(const std::string& page) {
  std::vector<std::vector<std::string>> rows;
  std::string table = page.substr(page.find("<h2>All pictures</h2>"));
  table = table.substr(0, table.find("</table>"));
  for (std::size_t from = table.find("<tr>"); from != std::string::npos; from = table.find("<tr>", from + 1))
    rows.push_back(found(table.substr(from, table.find("</tr>", from) - from), ">([^<]*)</t[dh]>"));
  return rows;
}

TEST(ReportChart, PlacesPointsTicksAndWhiskersOnLogarithmicAxes) {
  const ChartLine line{
      {0, false},
      {{1.0, 0.1, 0.1, 0.1, "a"}, {10.0, 0.01, 0.001, 0.1, "b < c"}, {100.0, 0.001, 0.001, 0.001, ""}}};
  const std::string svg = chart_svg("seconds", "FLIP", {line});
  // Two decades, and a tenth of one at each end, on 504 by 290 pixels from (64, 318).
  EXPECT_THAT(svg, HasSubstr(R"(<path d="M86.9 41.2L316.0 173.0L545.1 304.8"/>)"));
  EXPECT_THAT(svg, HasSubstr("M316.0 304.8V41.2"));
  EXPECT_THAT(found(svg, R"re(<text x="([0-9.]+)" y="338")re"), ElementsAre("86.9", "316.0", "545.1"));
  EXPECT_THAT(found(svg, R"re(text-anchor="middle">([0-9.]+)<)re"), ElementsAre("1", "10", "100"));
  EXPECT_THAT(found(svg, R"re(text-anchor="end">([0-9.]+)<)re"), ElementsAre("0.001", "0.01", "0.1"));
  EXPECT_THAT(found(svg, R"re(translate\(([0-9.]+ [0-9.]+)\)" d)re"),
              ElementsAre("86.9 41.2", "316.0 173.0", "545.1 304.8"));
  EXPECT_THAT(svg, HasSubstr("<title>b &#60; c</title>"));
}

TEST(ReportChart, HasRoundTicksForEverySpan) {
  for (const double span : {1.0, 1.5, 3.0, 30.0, 1e3, 1e9}) {
    const std::string svg =
        chart_svg("x", "y", {{{}, {{0.037, 1.0, 1.0, 1.0, ""}, {0.037 * span, 2.0, 2.0, 2.0, ""}}}});
    const std::vector<std::string> places = found(svg, R"re(<text x="([0-9.]+)" y="338")re");
    EXPECT_GE(places.size(), 3u) << span;
    for (std::size_t i = 1; i < places.size(); ++i)
      EXPECT_GT(std::stod(places[i]), std::stod(places[i - 1]) + 25.0) << span;
    EXPECT_THAT(svg, Not(HasSubstr("nan"))) << span;
  }
}

TEST(Report, NumbersAreThoseOfTheCsv) {
  const ordered_json all = results();
  const auto csv = read_csv(results_csv(all)), page = rows_of(page_of(all));
  ASSERT_EQ(page.size(), 5u);
  ASSERT_GT(page[0].size(), 15u);
  // Cells are by run in the page and by seed in the file: the first, the third and the second.
  for (const auto& [row, cell] : {std::pair{1u, 1u}, {2u, 3u}, {3u, 2u}}) {
    ASSERT_EQ(page[row].size(), page[0].size());
    for (std::size_t c = 3; c < page[0].size(); ++c) {
      const auto column = std::find(csv[0].begin(), csv[0].end(), page[0][c]);
      ASSERT_NE(column, csv[0].end()) << page[0][c];
      const std::string text = csv[cell][static_cast<std::size_t>(column - csv[0].begin())];
      EXPECT_EQ(page[row][c], text.empty() ? "–" : fmt::format("{:.4g}", std::stod(text))) << *column;
    }
  }
}

TEST(Report, FailedAndMissingCellsAreShownAsSuch) {
  ordered_json all = results();
  const std::string page = page_of(all);
  const auto rows = rows_of(page);
  const std::string run = "nrc gate stack adaptive,1, ";
  EXPECT_THAT(std::vector(rows[1].begin() + 1, rows[1].begin() + 4), ElementsAre(run + "4 steps", "", "1"));
  EXPECT_THAT(std::vector(rows[2].begin() + 1, rows[2].begin() + 4),
              ElementsAre(run + "4 steps", "failed: it &#60;broke&#62;", "2"));
  EXPECT_THAT(std::vector(rows[4].begin() + 1, rows[4].begin() + 4),
              ElementsAre(run + "8 steps", "not measured", "2"));
  EXPECT_THAT(rows[4].back(), "–");
  // Among the pictures, which are those of the first seed.
  EXPECT_THAT(page, Not(HasSubstr("<p class=\"none\">failed")));
  for (ordered_json& cell : all["cells"]) {
    if (cell["status"] == "failed") cell["seed"] = 0;
  }
  EXPECT_THAT(page_of(all), AllOf(HasSubstr("<p class=\"none\">failed: it &#60;broke&#62;</p>"),
                                  HasSubstr("<p class=\"none\">not measured</p>")));
  // A scene that could not be read has neither references nor pictures.
  for (ordered_json& cell : all["cells"])
    cell =
        failed_record({small_plan().scenes[0], small_plan().scenes[0].series[0], 1, 4, "3", ""}, "no scene");
  EXPECT_THAT(page_of(all), HasSubstr("<p class=\"none\">failed: no scene</p>"));
  all["cells"] = ordered_json::array();
  EXPECT_THAT(page_of(all), HasSubstr("Recipe"));
}

TEST(Report, ChartsHaveMeansOverSeedsAndLeaveOutWhatHasNoLogarithm) {
  ordered_json all = results();
  ordered_json second = all["cells"][0];
  second["seed"] = 2;
  second["errors"]["flip"] = 0.3;
  all["cells"][2] = second;
  EXPECT_THAT(page_of(all), HasSubstr("4 steps: 3.75 s, mean FLIP 0.2117 (0.1235 to 0.3 over 2 seeds)"));
  EXPECT_THAT(page_of(all), HasSubstr("relative MSE 0.015"));
  for (ordered_json& cell : all["cells"]) cell["errors"]["rel_mse_clean"] = -1e-4;
  EXPECT_THAT(page_of(all),
              AllOf(Not(HasSubstr("relative MSE")), HasSubstr("mean FLIP"), Not(HasSubstr("nan"))));
}

TEST(Report, NamesAreTextAndNothingIsLoaded) {
  const std::string hostile = "</script><script>\"'&<b>\xe2\x80\xa8\xff";
  ordered_json all = results();
  all["command"] = {hostile};
  all["machine"]["cpu"] = all["scenes"][0]["name"] = all["scenes"][0]["file"] = hostile;
  for (ordered_json& cell : all["cells"]) {
    for (const char* key : {"scene", "series", "run", "error", "command"}) cell[key] = hostile;
    cell["axes"]["row"] = hostile;
  }
  const std::string page = page_of(all);
  EXPECT_THAT(page, AllOf(HasSubstr("&#60;/script&#62;&#60;script&#62;&#34;"), Not(HasSubstr("<b>"))));
  EXPECT_EQ(found(page, "(<script|</script>)").size(), 2u);
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(found(page, R"re(((?:src|href)\s*=\s*["'](?!data:|")|@import|url\())re"), ElementsAre());
}

TEST(ReportPicture, HasSizeAndColourOfThePng) {
  const Decoded plain = decode(picture_uri(grey_picture(64, 40, 0.1f), {}));
  EXPECT_EQ(plain.width, 64);
  EXPECT_EQ(plain.height, 40);
  EXPECT_NEAR(plain.bytes[0], byte_of(0.1f), 2);
  const Decoded shown = decode(
      picture_uri(grey_picture(16, 16, 0.1f), {.exposure = 1.0f, .tonemap = renderer::Tonemap::filmic}));
  EXPECT_NEAR(shown.bytes[0], byte_of(0.1f, 2.0f, renderer::Tonemap::filmic), 2);
}

TEST(ReportPicture, IsMadeSmallerByMeansOfLight) {
  renderer::Picture stripes = grey_picture(2560, 51, 0.0f);
  std::vector<float>& values = stripes.layers.front().values;
  for (std::size_t i = 0; i < values.size(); i += 6)
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(i), 3, 1.0f);
  const Decoded decoded = decode(picture_uri(stripes, {}));
  EXPECT_EQ(decoded.width, 1280);
  EXPECT_EQ(decoded.height, 25);
  // Half the light is byte 188; half the byte would be 128.
  EXPECT_NEAR(decoded.bytes[3 * (7 * 1280 + 640)], 188, 3);
  EXPECT_EQ(decode(picture_uri(grey_picture(3841, 1, 0.5f), {})).width, 960);
}

TEST(Report, EmbedsPicturesAndTheReferenceForTheExposureOfEach) {
  const TemporaryFolder folder, other;
  for (const char* name : {"pictures", "references"}) std::filesystem::create_directories(folder / name);
  renderer::write_image(grey_picture(8, 8, 0.5f), folder / "pictures/1.png");
  renderer::write_image(grey_picture(8, 8, 1.0f), folder / "pictures/1-flip.png");
  folder.write("pictures/2.png", "no picture");
  renderer::write_image(grey_picture(8, 8, 0.1f), folder / "references/ref.exr");
  renderer::write_image(grey_picture(8, 8, 0.9f), other / "ref.exr");
  ordered_json all = results();
  all["cells"][1]["options"].update({{"exposure", 1.0}, {"tonemap", "filmic"}});
  const auto bytes_of = [&](const ordered_json& named) {
    std::vector<int> bytes;
    const std::string page = make_report(named, folder.path().string());
    for (const std::string& uri : found(page, R"re(<img alt="[^"]+" src="([^"]*)")re"))
      bytes.push_back(decode(uri).bytes[0]);
    EXPECT_EQ(found(page, "(pictures?</p>|: no picture)").size(), 2u) << "the second picture and its map";
    return bytes;
  };
  EXPECT_THAT(bytes_of(all),
              ::testing::Pointwise(
                  ::testing::DoubleNear(2.0),
                  {byte_of(0.1f), byte_of(0.1f, 2.0f, renderer::Tonemap::filmic), byte_of(0.5f), 255}));
  all["scenes"][0]["references"][0]["file"] = (other / "ref.exr").string();
  EXPECT_NEAR(bytes_of(all)[0], byte_of(0.9f), 2) << "an absolute path is taken as it is";
}

}  // namespace
}  // namespace gatelight::apps

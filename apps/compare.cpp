#include "renderer/metrics/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "apps/reports/compare_report.h"
#include "apps/seeds.h"
#include "apps/settings/file_names.h"
#include "apps/settings/flags.h"
#include "apps/settings/frame_range.h"
#include "apps/settings/option_table.h"
#include "apps/settings/picture_output.h"
#include "apps/subcommand.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"
#include "apps/terminal/terminal.h"
#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "renderer/metrics/merge.h"
#include "renderer/metrics/ssim.h"

namespace gatelight::apps {
namespace {

using renderer::NamedPicture;
using renderer::Picture;

constexpr const char* kCompareFooter = R"(Over the red, green and blue of the beauty layers:
  mse       mean squared error
  rel_mse   mean of the squared error over (squared reference + 0.01)
  psnr      peak signal to noise ratio in dB, for a peak of 1
  mean      mean of the absolute difference, and of the signed one (test minus reference)
  max       largest absolute difference
  ssim      mean structural similarity (Wang et al. 2004) of flip's input in grey: 1 for equal pictures. A Gaussian
            window of 11x11 pixels that must lie within the picture, K1 0.01, K2 0.03; none for smaller pictures
  flip      LDR-FLIP (2020), the visible difference when the pictures alternate: mean, quartiles weighted by the
            error, smallest and largest. Radiance is shown with --exposure and --tonemap, cut to [0, 1]
  hdr_flip  HDR-FLIP (2021): the largest FLIP over the exposures that suit the reference
Pictures with pixels that are not finite are refused, unless --metric names only those that can leave such pixels out
(mse, rel_mse, psnr, mean, max); then they are counted and reported. PNG files are converted to linear first.

With --halves the pictures are the means of REFERENCE and REF2, TEST and TEST2 (weighted by their samples per pixel),
and bias_rel_mse is the rel_mse that would remain with infinitely many samples, free of the noise of all four: the mean
of (TEST - REFERENCE)(TEST2 - REF2) over (squared reference + 0.01). Each must have a seed of its own.

Examples:
  gatelight compare reference.exr test.exr
  gatelight compare reference.exr test.exr --metric rel_mse,flip --json - --error-map flip.png
  gatelight compare reference-a.exr test-1.exr --halves reference-b.exr test-2.exr)";

enum class Map : std::uint8_t { flip, hdr_flip, relative };
constexpr renderer::Choice<Map> kMaps[] = {
    {"flip", Map::flip}, {"hdr_flip", Map::hdr_flip}, {"relative", Map::relative}};

struct CompareSettings {
  std::string reference;
  std::string test;
  std::vector<std::string> halves;  ///< empty, or the second reference and the second test
  std::string metrics;
  std::string json;
  std::string error_map;
  Map map = Map::flip;
  renderer::FlipOptions flip;
};

std::vector<Metric> choose_metrics(const std::string& list) {
  std::vector<Metric> chosen;
  if (list.empty()) {
    for (const renderer::Choice<Metric>& choice : kMetrics) chosen.push_back(choice.value);
    return chosen;
  }
  for (const std::string& word : split_list("--metric", list)) {
    const Metric metric = parse_choice("--metric", word, kMetrics);
    if (std::find(chosen.begin(), chosen.end(), metric) == chosen.end()) chosen.push_back(metric);
  }
  return chosen;
}

/// The picture of one file, or the mean of two; `halves` receives the two.
Picture read_pictures(const std::vector<std::string>& files, std::vector<Picture>& halves) {
  Picture first = renderer::read_image(files.front());
  if (files.size() == 1) return first;
  halves.push_back(std::move(first));
  halves.push_back(renderer::read_image(files.back()));
  SeedsSeen seeds;
  for (std::size_t i = 0; i < halves.size(); ++i) seeds.add(halves[i], files[i]);
  return renderer::merge_pictures({{halves.front(), files.front()}, {halves.back(), files.back()}});
}

void check_outputs(const CompareSettings& settings) {
  FileNames names;
  names.read("REFERENCE", settings.reference);
  names.read("TEST", settings.test);
  for (const std::string& half : settings.halves) names.read("--halves", half);
  names.write("--error-map", settings.error_map);
  names.write("--json", settings.json);
  if (!settings.error_map.empty()) {
    refuse_frame_place("--error-map", settings.error_map);
    if (std::filesystem::path(settings.error_map).extension() != ".png") {
      throw UsageError(fmt::format("--error-map: '{}' is not a .png file", settings.error_map));
    }
    renderer::check_image_output(settings.error_map);
  }
  if (!settings.json.empty() && settings.json != "-") check_writable(settings.json);
}

/// Whether the metric is a mean over pixels, so that some pixels can be left out.
bool leaves_pixels_out(Metric metric) {
  return metric != Metric::ssim && metric != Metric::flip && metric != Metric::hdr_flip;
}

void check_finite(const CompareSettings& settings, const CompareReport& report) {
  const renderer::ErrorMetrics& errors = report.errors;
  if (errors.nonfinite_reference + errors.nonfinite_test == 0) return;
  const std::string counts =
      fmt::format("pixels that are not finite: {} in '{}', {} in '{}'", errors.nonfinite_reference,
                  settings.reference, errors.nonfinite_test, settings.test);
  const bool possible = std::all_of(report.metrics.begin(), report.metrics.end(), leaves_pixels_out) &&
                        (settings.error_map.empty() || settings.map == Map::relative);
  if (!possible) {
    throw InputError(fmt::format(
        "{}; expected none for ssim, flip and hdr_flip (--metric mse,rel_mse,psnr,mean,max leaves them out)",
        counts));
  }
  if (report.errors.pixels == 0) throw InputError(fmt::format("{}; nothing is left to compare", counts));
  log_warning(fmt::format("{}; they are left out", counts));
}

void measure_looks(CompareReport& report, const NamedPicture& reference, const NamedPicture& test,
                   bool by_name) {
  const renderer::FlipOptions& flip = report.flip_options;
  for (const Metric metric : report.metrics) {
    if (metric == Metric::ssim && (by_name || has_ssim(reference.picture)))
      report.ssim = ssim(reference, test, {.exposure = flip.exposure, .tonemap = flip.tonemap});
    if (metric == Metric::flip) report.flip = ldr_flip(reference, test, flip);
    if (metric == Metric::hdr_flip) report.hdr_flip = hdr_flip(reference, test, flip);
  }
}

Picture make_map(const CompareSettings& settings, const CompareReport& report, const NamedPicture& reference,
                 const NamedPicture& test) {
  switch (settings.map) {
    case Map::relative:
      return renderer::error_map(reference, test);
    case Map::hdr_flip:
      return flip_map(report.hdr_flip ? *report.hdr_flip : hdr_flip(reference, test, settings.flip));
    case Map::flip:
      break;
  }
  return flip_map(report.flip ? *report.flip : ldr_flip(reference, test, settings.flip));
}

int run_compare(const CompareSettings& settings) {
  CompareReport report{.references = {settings.reference},
                       .tests = {settings.test},
                       .metrics = choose_metrics(settings.metrics),
                       .flip_options = settings.flip};
  check_outputs(settings);
  if (!settings.halves.empty()) {
    report.references.push_back(settings.halves.front());
    report.tests.push_back(settings.halves.back());
  }
  std::vector<Picture> references;
  std::vector<Picture> tests;
  const Picture reference_picture = read_pictures(report.references, references);
  const Picture test_picture = read_pictures(report.tests, tests);
  const NamedPicture reference{reference_picture, settings.reference};
  const NamedPicture test{test_picture, settings.test};
  report.width = reference_picture.width;
  report.height = reference_picture.height;
  report.errors = renderer::compare_pictures(reference, test);
  check_finite(settings, report);
  if (!settings.halves.empty()) {
    report.bias_rel_mse = renderer::squared_bias(
        {{references.front(), report.references.front()}, {references.back(), report.references.back()}},
        {{tests.front(), report.tests.front()}, {tests.back(), report.tests.back()}});
  }
  measure_looks(report, reference, test, !settings.metrics.empty());
  if (!settings.error_map.empty()) {
    renderer::write_image(make_map(settings, report, reference, test), settings.error_map);
  }
  if (!settings.json.empty()) write_text(settings.json, compare_json(report));
  // With JSON on stdout nothing else is printed there, so that it can be parsed.
  if (settings.json != "-") write_text("-", compare_text(report));
  return kDone;
}

std::vector<Option> option_table(CompareSettings& settings) {
  constexpr RealRange kPixelsPerDegree{renderer::kMinPixelsPerDegree, renderer::kMaxPixelsPerDegree};
  constexpr RealRange kStops{-100.0, 100.0};
  using namespace renderer;
  std::vector<Option> table = {
      positional("REFERENCE", settings.reference, "Reference picture, .exr, .hdr or .png"),
      positional("TEST", settings.test, "Picture to be judged"),
      any_words("halves", settings.halves, "REF2 TEST2",
                "Second halves of reference and test: also estimates the bias without noise"),
      any_word("metric", settings.metrics, "LIST",
               "Metrics, separated by commas: mse,rel_mse,psnr,mean,max,ssim,flip,hdr_flip (default: all)"),
      any_word("json", settings.json, "FILE|-", "Result as JSON; - is stdout"),
      any_word("error-map", settings.error_map, "FILE.png",
               "Picture of the errors. FLIP's: black 0, violet, red, orange, pale yellow 1; relative: black "
               "0, violet 0.1, red 0.25, yellow 0.5, white 1 and more, green not finite"),
      choice("map", settings.map, kMaps, "Which errors --error-map shows"),
      number("pixels-per-degree", settings.flip.pixels_per_degree, kPixelsPerDegree, "N",
             "For FLIP: pixels of a degree of visual angle. The default is a monitor 0.7 m wide with 3840 "
             "pixels, seen from 0.7 m"),
      number("exposure", settings.flip.exposure, kStops, "EV",
             "For flip and ssim: stops by which pictures are brighter"),
      choice("tonemap", settings.flip.tonemap, "For flip and ssim: curve of pictures")};
  for (Option& option : table) {
    if (option.name == "halves") option.words = 2;
    if (option.name == "pixels-per-degree") option.default_text = "67.02";
  }
  return table;
}

}  // namespace

Subcommand add_compare_command(CLI::App& root) {
  CLI::App* app =
      add_subcommand(root, "compare", "Measure how far one picture is from another", kCompareFooter);
  const auto settings = std::make_shared<CompareSettings>();
  add_flags(*app, option_table(*settings));
  return {app, [settings] { return run_compare(*settings); }};
}

}  // namespace gatelight::apps

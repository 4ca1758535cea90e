#include "renderer/metrics/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "apps/compare_frames.h"
#include "apps/reports/compare_report.h"
#include "apps/seeds.h"
#include "apps/settings/compare_settings.h"
#include "apps/settings/file_names.h"
#include "apps/settings/flags.h"
#include "apps/settings/frame_range.h"
#include "apps/settings/option_table.h"
#include "apps/settings/picture_output.h"
#include "apps/subcommand.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/terminal.h"
#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "renderer/metrics/merge.h"

namespace gatelight::apps {
namespace {

using renderer::NamedPicture;
using renderer::Picture;

constexpr const char* kCompareFooter = R"(Over the red, green and blue of the beauty layers:
  mse       mean squared error
  rel_mse   mean of the squared error over (squared reference + 0.01)
  psnr      peak signal to noise ratio in dB, for a peak of 1
  mean      mean absolute difference, and mean signed difference (test minus reference)
  max       largest absolute difference
  ssim      mean structural similarity (Wang et al. 2004) of flip's input in grey: 1 for equal pictures. The Gaussian
            window of 11x11 pixels must lie within the picture; K1 is 0.01, K2 0.03. Smaller pictures have no ssim
  flip      LDR-FLIP (2020), the visible difference when the pictures alternate: mean, quartiles weighted by the
            error, smallest and largest. Radiance is shown with --exposure and --tonemap, cut to [0, 1]
  hdr_flip  HDR-FLIP (2021): the largest FLIP over the exposures that suit the reference
  temporal  needs two or more --frames: compares the changes from frame to frame in TEST with those in REFERENCE, in
            flip's input (sRGB). Root mean squares: temporal_low of the low frequencies (a Gaussian of 6 pixels;
            flickering areas), temporal_high of the high frequencies (noise, edges)
Pictures with pixels that are not finite are refused, unless --metric names only metrics that can ignore such pixels
(mse, rel_mse, psnr, mean, max); these pixels are then counted and reported. PNG files are first converted to linear.

With --frames, each value is the mean over the frames; the JSON also contains the values of each frame.

With --halves, the mean of REFERENCE and REF2 is compared with the mean of TEST and TEST2 (weighted by their samples per
pixel). bias_rel_mse is the rel_mse that would remain with infinitely many samples, free of the noise of all four: the
mean of (TEST - REFERENCE)(TEST2 - REF2) over (squared reference + 0.01). All four pictures need different seeds.

Examples:
  gatelight compare reference.exr test.exr
  gatelight compare reference.exr test.exr --metric rel_mse,flip --json - --error-map flip.png
  gatelight compare reference-a.exr test-1.exr --halves reference-b.exr test-2.exr
  gatelight compare reference-%04d.exr test-%04d.exr --frames 0:47 --metric flip,temporal)";

std::vector<Metric> choose_metrics(const CompareSettings& settings) {
  std::vector<Metric> chosen;
  if (settings.metrics.empty()) {
    for (const renderer::Choice<Metric>& choice : kMetrics) {
      if (choice.value != Metric::temporal || settings.has_pairs_of_frames()) chosen.push_back(choice.value);
    }
    return chosen;
  }
  for (const std::string& word : split_list("metric", settings.metrics)) {
    const Metric metric = parse_choice("metric", word, kMetrics);
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
  for (const int frame : settings.frames ? settings.frames->numbers() : std::vector{0}) {
    names.read("REFERENCE", settings.frames ? name_of_frame(settings.reference, frame) : settings.reference);
    names.read("TEST", settings.frames ? name_of_frame(settings.test, frame) : settings.test);
  }
  for (const std::string& half : settings.halves) names.read("halves", half);
  names.write("error-map", settings.error_map);
  names.write("json", settings.json);
  if (!settings.error_map.empty()) {
    refuse_frame_place("error-map", settings.error_map);
    if (std::filesystem::path(settings.error_map).extension() != ".png") {
      throw BadOption({"error-map", settings.error_map, "", "a .png file"});
    }
    renderer::check_image_output(settings.error_map);
  }
  if (!settings.json.empty() && settings.json != "-") check_writable(settings.json);
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

void compare_pair(const CompareSettings& settings, const std::vector<Metric>& metrics) {
  CompareReport report{.references = {settings.reference},
                       .tests = {settings.test},
                       .metrics = metrics,
                       .flip_options = settings.flip};
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
  const bool map_needs_all = !settings.error_map.empty() && settings.map != Map::relative;
  measure_pair(report, reference, test, map_needs_all, !settings.metrics.empty());
  if (!settings.halves.empty()) {
    report.bias_rel_mse = renderer::squared_bias(
        {{references.front(), report.references.front()}, {references.back(), report.references.back()}},
        {{tests.front(), report.tests.front()}, {tests.back(), report.tests.back()}});
  }
  if (!settings.error_map.empty()) {
    renderer::write_image(make_map(settings, report, reference, test), settings.error_map);
  }
  if (!settings.json.empty()) write_text(settings.json, compare_json(report));
  // With JSON on stdout nothing else is printed there, so that it can be parsed.
  if (settings.json != "-") write_text("-", compare_text(report));
}

int run_compare(const CompareSettings& settings) {
  const std::vector<Metric> metrics = choose_metrics(settings);
  check_frames(settings, metrics);
  check_outputs(settings);
  if (settings.frames) {
    compare_frames(settings, metrics);
  } else {
    compare_pair(settings, metrics);
  }
  return kDone;
}

std::vector<Option> option_table(CompareSettings& settings) {
  constexpr RealRange kPixelsPerDegree{renderer::kMinPixelsPerDegree, renderer::kMaxPixelsPerDegree};
  constexpr RealRange kStops{-100.0, 100.0};
  using namespace renderer;
  std::vector<Option> table = {
      positional("REFERENCE", settings.reference, "Reference picture, .exr, .hdr or .png"),
      positional("TEST", settings.test, "Picture to compare with it, .exr, .hdr or .png"),
      any_words("halves", settings.halves, "REF2 TEST2",
                "Second halves of reference and test; also estimate the bias without noise"),
      read_by(
          "frames", settings.frames, "A:B[:STEP]",
          "Compare these frames of two sequences; REFERENCE and TEST contain %04d, #### or {frame} for the "
          "number",
          [](const std::optional<FrameList>& frames) { return frames ? text_of(*frames) : OptionValue(); },
          parse_frames),
      any_word(
          "metric", settings.metrics, "LIST",
          "Metrics, separated by commas: mse,rel_mse,psnr,mean,max,ssim,flip,hdr_flip,temporal (default: "
          "all)"),
      any_word("json", settings.json, "FILE|-", "Write the result as JSON; - is stdout"),
      any_word(
          "error-map", settings.error_map, "FILE.png",
          "Write a picture of the errors. FLIP: from black (0) through violet, red and orange to pale yellow "
          "(1); relative: black 0, violet 0.1, red 0.25, yellow 0.5, white 1 and more, green not finite"),
      choice("map", settings.map, kMaps, "Errors that --error-map shows"),
      number("pixels-per-degree", settings.flip.pixels_per_degree, kPixelsPerDegree, "N",
             "For FLIP: pixels per degree of visual angle. The default is a monitor with a width of 0.7 m "
             "and 3840 pixels, seen from 0.7 m"),
      number("exposure", settings.flip.exposure, kStops, "EV",
             "For flip, ssim and temporal: exposure of the pictures in stops"),
      choice("tonemap", settings.flip.tonemap, "For flip, ssim and temporal: tone curve of the pictures")};
  for (Option& option : table) {
    if (option.name == "halves") option.words = 2;
    if (option.name == "pixels-per-degree") option.default_text = "67.02";
  }
  return table;
}

}  // namespace

Subcommand add_compare_command(CLI::App& root) {
  CLI::App* app =
      add_subcommand(root, "compare", "Measure the difference between two pictures", kCompareFooter);
  const auto settings = std::make_shared<CompareSettings>();
  add_flags(*app, option_table(*settings));
  return {.app = app, .run = [settings] { return run_compare(*settings); }};
}

}  // namespace gatelight::apps

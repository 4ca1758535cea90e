#include "apps/compare_frames.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "apps/reports/compare_report.h"
#include "apps/settings/picture_output.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/terminal.h"
#include "renderer/image/image_read.h"
#include "renderer/metrics/temporal.h"

namespace gatelight::apps {
namespace {

using renderer::NamedPicture;
using renderer::Picture;

bool has(const std::vector<Metric>& metrics, Metric metric) {
  return std::find(metrics.begin(), metrics.end(), metric) != metrics.end();
}

}  // namespace

void check_frames(const CompareSettings& settings, const std::vector<Metric>& metrics) {
  if (has(metrics, Metric::temporal) && !settings.has_pairs_of_frames())
    throw BadOption({"metric", "temporal", "compares successive frames", "`frames` with two or more frames"});
  if (!settings.frames) {
    refuse_frame_place("REFERENCE", settings.reference);
    refuse_frame_place("TEST", settings.test);
    return;
  }
  if (!settings.halves.empty()) throw BadOption({"halves", "", "excludes `frames`", "one of them"});
  if (!settings.error_map.empty()) throw BadOption({"error-map", "", "excludes `frames`", "one of them"});
  require_frame_place("REFERENCE", settings.reference);
  require_frame_place("TEST", settings.test);
}

void compare_frames(const CompareSettings& settings, const std::vector<Metric>& metrics) {
  CompareFramesReport report{.whole = {.references = {settings.reference},
                                       .tests = {settings.test},
                                       .metrics = metrics,
                                       .flip_options = settings.flip}};
  renderer::TemporalMeter meter({.exposure = settings.flip.exposure, .tonemap = settings.flip.tonemap});
  Picture first;  // without its values
  std::string first_name;
  for (const int frame : settings.frames->numbers()) {
    const std::string reference_name = name_of_frame(settings.reference, frame);
    const std::string test_name = name_of_frame(settings.test, frame);
    const Picture reference_picture = renderer::read_image(reference_name);
    const Picture test_picture = renderer::read_image(test_name);
    const NamedPicture reference{reference_picture, reference_name};
    const NamedPicture test{test_picture, test_name};
    if (report.frames.empty()) {
      first = without_values(reference_picture);
      first_name = reference_name;
    }
    require_comparable({first, first_name}, reference);
    CompareReport pair{.metrics = metrics, .flip_options = settings.flip};
    measure_pair(pair, reference, test, false, !settings.metrics.empty());
    if (has(metrics, Metric::temporal)) meter.add(reference, test);
    for (std::optional<renderer::FlipResult>* flip : {&pair.flip, &pair.hdr_flip}) {
      if (*flip) (*flip)->errors = {};
    }
    report.whole.errors.pixels += pair.errors.pixels;
    report.whole.errors.nonfinite_reference += pair.errors.nonfinite_reference;
    report.whole.errors.nonfinite_test += pair.errors.nonfinite_test;
    report.numbers.push_back(frame);
    report.frames.push_back(std::move(pair));
  }
  report.whole.width = first.width;
  report.whole.height = first.height;
  report.temporal = meter.deviation();
  if (!settings.json.empty()) write_text(settings.json, compare_frames_json(report));
  // With JSON on stdout nothing else is printed there, so that it can be parsed.
  if (settings.json != "-") write_text("-", compare_frames_text(report));
}

}  // namespace gatelight::apps

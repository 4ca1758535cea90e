#include "apps/reports/compare_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "apps/reports/json.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"
#include "apps/terminal/text.h"
#include "renderer/metrics/ssim.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

/// Of a metric that was not requested, or of SSIM where the picture is smaller than its window.
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double mean_of(const std::optional<renderer::FlipResult>& flip) {
  return flip ? flip->summary.mean : kNone;
}

/// A number of a comparison, with its key in the JSON.
struct ErrorValue {
  Metric metric;
  const char* key;
  double (*of)(const CompareReport&);
};
constexpr ErrorValue kErrorValues[] = {
    {Metric::mse, "mse", [](const CompareReport& r) { return r.errors.mse; }},
    {Metric::rel_mse, "rel_mse", [](const CompareReport& r) { return r.errors.rel_mse; }},
    {Metric::psnr, "psnr", [](const CompareReport& r) { return r.errors.psnr; }},
    {Metric::mean, "mean_error", [](const CompareReport& r) { return r.errors.mean_error; }},
    {Metric::mean, "mean_difference", [](const CompareReport& r) { return r.errors.mean_difference; }},
    {Metric::max, "max_error", [](const CompareReport& r) { return r.errors.max_error; }},
    {Metric::ssim, "ssim", [](const CompareReport& r) { return r.ssim.value_or(kNone); }},
    {Metric::flip, "flip", [](const CompareReport& r) { return mean_of(r.flip); }},
    {Metric::hdr_flip, "hdr_flip", [](const CompareReport& r) { return mean_of(r.hdr_flip); }}};

/// The values of the requested metrics, in their order.
std::vector<ErrorValue> requested_values(const CompareReport& report) {
  std::vector<ErrorValue> values;
  for (const Metric metric : report.metrics) {
    std::copy_if(std::begin(kErrorValues), std::end(kErrorValues), std::back_inserter(values),
                 [metric](const ErrorValue& value) { return value.metric == metric; });
  }
  return values;
}

/// FLIP with all its numbers, where the value is one.
const renderer::FlipResult* flip_of(const CompareReport& report, Metric metric) {
  if (metric == Metric::flip && report.flip) return &*report.flip;
  return metric == Metric::hdr_flip && report.hdr_flip ? &*report.hdr_flip : nullptr;
}

bool is_look(Metric metric) {
  return metric == Metric::ssim || metric == Metric::flip || metric == Metric::hdr_flip;
}

/// A mean with the options by which the metric sees the pictures.
ordered_json look_json(const CompareReport& report, Metric metric, double mean) {
  if (std::isnan(mean)) return nullptr;
  ordered_json json = {{"mean", mean}};
  const renderer::FlipResult* flip = flip_of(report, metric);
  if (flip) {
    json["weighted_median"] = flip->summary.weighted_median;
    json["first_quartile"] = flip->summary.first_quartile;
    json["third_quartile"] = flip->summary.third_quartile;
    json["min"] = flip->summary.min;
    json["max"] = flip->summary.max;
  }
  if (metric != Metric::ssim) json["pixels_per_degree"] = report.flip_options.pixels_per_degree;
  if (metric != Metric::hdr_flip) {
    json["exposure"] = report.flip_options.exposure;
    json["tonemap"] = enum_name(report.flip_options.tonemap);
  } else if (flip) {
    json["start_exposure"] = flip->start_exposure;
    json["stop_exposure"] = flip->stop_exposure;
    json["exposures"] = flip->exposures;
  }
  return json;
}

void add_value(ordered_json& json, const CompareReport& report, const ErrorValue& value, double number) {
  json[value.key] = is_look(value.metric) ? look_json(report, value.metric, number) : json_number(number);
  if (value.metric == Metric::psnr) json["psnr_peak"] = renderer::kPsnrPeak;
}

std::string value_text(const ErrorValue& value, double number, const std::string& more) {
  if (std::isnan(number)) return fmt::format("{:<16} -\n", value.key);
  const char* unit = value.metric == Metric::psnr ? " dB" : "";
  return fmt::format("{:<16} {:.6g}{}{}\n", value.key, number, unit, more);
}

/// What the JSON begins with.
ordered_json head_json(const CompareReport& report) {
  const renderer::ErrorMetrics& errors = report.errors;
  return {{"schema", 1},
          {"reference", report.references.front()},
          {"test", report.tests.front()},
          {"width", report.width},
          {"height", report.height},
          {"pixels", errors.pixels},
          {"nonfinite", {{"reference", errors.nonfinite_reference}, {"test", errors.nonfinite_test}}}};
}

/// Of each frame.
std::vector<double> numbers_of(const CompareFramesReport& report, const ErrorValue& value) {
  std::vector<double> numbers;
  for (const CompareReport& frame : report.frames) numbers.push_back(value.of(frame));
  return numbers;
}

double mean_of(const std::vector<double>& numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), 0.0) / static_cast<double>(numbers.size());
}

/// The smallest and the largest number with their frames.
std::string range_text(const CompareFramesReport& report, const std::vector<double>& numbers) {
  const auto [low, high] = std::minmax_element(numbers.begin(), numbers.end());
  const auto frame = [&](auto place) {
    return report.numbers[static_cast<std::size_t>(place - numbers.begin())];
  };
  return fmt::format(", from {:.6g} (frame {}) to {:.6g} (frame {})", *low, frame(low), *high, frame(high));
}

void measure_errors(CompareReport& report, const renderer::NamedPicture& reference,
                    const renderer::NamedPicture& test, bool others_need_all) {
  report.errors = renderer::compare_pictures(reference, test);
  const renderer::ErrorMetrics& errors = report.errors;
  if (errors.nonfinite_reference + errors.nonfinite_test == 0) return;
  const std::string counts =
      fmt::format("pixels that are not finite: {} in '{}', {} in '{}'", errors.nonfinite_reference,
                  reference.name, errors.nonfinite_test, test.name);
  const auto needs_all = [](Metric metric) { return is_look(metric) || metric == Metric::temporal; };
  if (others_need_all || std::any_of(report.metrics.begin(), report.metrics.end(), needs_all)) {
    throw InputError(fmt::format(
        "{}; expected none for ssim, flip, hdr_flip and temporal (--metric mse,rel_mse,psnr,mean,max "
        "ignores them)",
        counts));
  }
  if (errors.pixels == 0) throw InputError(fmt::format("{}; nothing is left to compare", counts));
  log_warning(fmt::format("{}; they are ignored", counts));
}

}  // namespace

void measure_pair(CompareReport& report, const renderer::NamedPicture& reference,
                  const renderer::NamedPicture& test, bool others_need_all, bool by_name) {
  measure_errors(report, reference, test, others_need_all);
  measure_looks(report, reference, test, by_name);
}

bool measure_looks(CompareReport& report, const renderer::NamedPicture& reference,
                   const renderer::NamedPicture& test, bool by_name,
                   const std::function<bool(double)>& go_on) {
  const renderer::FlipOptions& flip = report.flip_options;
  for (const Metric metric : report.metrics) {
    if (metric == Metric::ssim && (by_name || renderer::has_ssim(reference.picture)))
      report.ssim = renderer::ssim(reference, test, {.exposure = flip.exposure, .tonemap = flip.tonemap});
    if (metric == Metric::flip) report.flip = renderer::ldr_flip(reference, test, flip);
    if (metric == Metric::hdr_flip) {
      report.hdr_flip = renderer::hdr_flip(reference, test, flip, go_on);
      if (!report.hdr_flip) return false;
    }
  }
  return true;
}

std::string compare_json(const CompareReport& report) {
  ordered_json json = head_json(report);
  if (report.bias_rel_mse) json["halves"] = {report.references.back(), report.tests.back()};
  for (const ErrorValue& value : requested_values(report)) add_value(json, report, value, value.of(report));
  if (report.bias_rel_mse) json["bias_rel_mse"] = json_number(*report.bias_rel_mse);
  return json_text(json) + "\n";
}

std::string compare_text(const CompareReport& report) {
  std::string text;
  for (const ErrorValue& value : requested_values(report)) {
    std::string more;
    if (const renderer::FlipResult* flip = flip_of(report, value.metric)) {
      const renderer::FlipSummary& s = flip->summary;
      more = fmt::format(", weighted quartiles {:.6g} {:.6g} {:.6g}, from {:.6g} to {:.6g}", s.first_quartile,
                         s.weighted_median, s.third_quartile, s.min, s.max);
    }
    text += value_text(value, value.of(report), more);
  }
  if (report.bias_rel_mse) text += fmt::format("{:<16} {:.6g}\n", "bias_rel_mse", *report.bias_rel_mse);
  return text;
}

std::string compare_frames_json(const CompareFramesReport& report) {
  ordered_json json = head_json(report.whole);
  ordered_json frames = ordered_json::array();
  for (const int number : report.numbers) frames.push_back({{"frame", number}});
  for (const ErrorValue& value : requested_values(report.whole)) {
    const std::vector<double> numbers = numbers_of(report, value);
    add_value(json, report.whole, value, mean_of(numbers));
    for (std::size_t i = 0; i < numbers.size(); ++i) frames[i][value.key] = json_number(numbers[i]);
  }
  if (report.temporal) {
    json["temporal_low"] = report.temporal->low;
    json["temporal_high"] = report.temporal->high;
  }
  json["frames"] = frames;
  return json_text(json) + "\n";
}

std::string compare_frames_text(const CompareFramesReport& report) {
  std::string text = fmt::format("{:<16} {}\n", "frames", report.frames.size());
  for (const ErrorValue& value : requested_values(report.whole)) {
    const std::vector<double> numbers = numbers_of(report, value);
    const bool varies = value.metric == Metric::rel_mse || value.metric == Metric::flip;
    text += value_text(value, mean_of(numbers), varies ? range_text(report, numbers) : "");
  }
  if (report.temporal) {
    text += fmt::format("{:<16} {:.6g}\n", "temporal_low", report.temporal->low);
    text += fmt::format("{:<16} {:.6g}\n", "temporal_high", report.temporal->high);
  }
  return text;
}

}  // namespace gatelight::apps

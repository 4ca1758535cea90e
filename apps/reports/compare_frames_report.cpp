#include "apps/reports/compare_frames_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "apps/reports/json.h"
#include "apps/terminal/text.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

/// Of a metric that was not requested, or of SSIM where the picture is smaller than its window.
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// One number of each frame.
struct Series {
  Metric metric;
  std::string key;
  std::vector<double> values;

  double mean() const {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  }
};

std::vector<Series> series_of(const CompareFramesReport& report) {
  std::vector<Series> all;
  const auto add = [&](Metric metric, const char* key, const auto& value_of) {
    Series& series = all.emplace_back(Series{metric, key, {}});
    for (const CompareReport& frame : report.frames) series.values.push_back(value_of(frame));
  };
  const auto mean = [](const std::optional<renderer::FlipResult>& flip) {
    return flip ? flip->summary.mean : kNone;
  };
  for (const Metric metric : report.whole.metrics) {
    for (const ErrorValue& value : kErrorValues) {
      if (value.metric == metric)
        add(metric, value.key, [&](const CompareReport& frame) { return frame.errors.*value.member; });
    }
    if (metric == Metric::ssim)
      add(metric, "ssim", [](const CompareReport& frame) { return frame.ssim.value_or(kNone); });
    if (metric == Metric::flip)
      add(metric, "flip", [&](const CompareReport& frame) { return mean(frame.flip); });
    if (metric == Metric::hdr_flip)
      add(metric, "hdr_flip", [&](const CompareReport& frame) { return mean(frame.hdr_flip); });
  }
  return all;
}

ordered_json mean_json(const CompareFramesReport& report, const Series& series) {
  const double mean = series.mean();
  const bool is_flip = series.metric == Metric::flip || series.metric == Metric::hdr_flip;
  if (!is_flip && series.metric != Metric::ssim) return json_number(mean);
  if (std::isnan(mean)) return nullptr;
  ordered_json json = {{"mean", mean}};
  if (is_flip) json["pixels_per_degree"] = report.whole.flip_options.pixels_per_degree;
  if (series.metric != Metric::hdr_flip) {
    json["exposure"] = report.whole.flip_options.exposure;
    json["tonemap"] = enum_name(report.whole.flip_options.tonemap);
  }
  return json;
}

ordered_json frames_json(const CompareFramesReport& report, const std::vector<Series>& all) {
  ordered_json frames = ordered_json::array();
  for (std::size_t i = 0; i < report.frames.size(); ++i) {
    ordered_json frame = {{"frame", report.numbers[i]}};
    for (const Series& series : all) frame[series.key] = json_number(series.values[i]);
    frames.push_back(std::move(frame));
  }
  return frames;
}

std::string series_text(const CompareFramesReport& report, const Series& series) {
  const double mean = series.mean();
  if (std::isnan(mean)) return fmt::format("{:<16} -\n", series.key);
  std::string text = fmt::format("{:<16} {:.6g}", series.key, mean);
  if (series.metric == Metric::psnr) text += " dB";
  if (series.metric == Metric::rel_mse || series.metric == Metric::flip) {
    const auto [low, high] = std::minmax_element(series.values.begin(), series.values.end());
    const auto frame = [&](auto place) {
      return report.numbers[static_cast<std::size_t>(place - series.values.begin())];
    };
    text +=
        fmt::format(", from {:.6g} (frame {}) to {:.6g} (frame {})", *low, frame(low), *high, frame(high));
  }
  return text + "\n";
}

}  // namespace

std::string compare_frames_json(const CompareFramesReport& report) {
  ordered_json json = head_json(report.whole);
  const std::vector<Series> all = series_of(report);
  for (const Series& series : all) {
    json[series.key] = mean_json(report, series);
    if (series.metric == Metric::psnr) json["psnr_peak"] = renderer::kPsnrPeak;
  }
  if (report.temporal) {
    json["temporal_low"] = report.temporal->low;
    json["temporal_high"] = report.temporal->high;
  }
  json["frames"] = frames_json(report, all);
  return json_text(json) + "\n";
}

std::string compare_frames_text(const CompareFramesReport& report) {
  std::string text = fmt::format("{:<16} {}\n", "frames", report.frames.size());
  for (const Series& series : series_of(report)) text += series_text(report, series);
  if (report.temporal) {
    text += fmt::format("{:<16} {:.6g}\n", "temporal_low", report.temporal->low);
    text += fmt::format("{:<16} {:.6g}\n", "temporal_high", report.temporal->high);
  }
  return text;
}

}  // namespace gatelight::apps

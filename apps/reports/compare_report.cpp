#include "apps/reports/compare_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/reports/json.h"
#include "apps/terminal/text.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

const renderer::FlipResult& flip_of(const CompareReport& report, Metric metric) {
  return metric == Metric::flip ? report.flip.value() : report.hdr_flip.value();
}

bool is_flip(Metric metric) {
  return metric == Metric::flip || metric == Metric::hdr_flip;
}

ordered_json ssim_json(const CompareReport& report) {
  if (!report.ssim) return nullptr;
  return {{"mean", *report.ssim},
          {"exposure", report.flip_options.exposure},
          {"tonemap", enum_name(report.flip_options.tonemap)}};
}

ordered_json flip_json(const CompareReport& report, Metric metric) {
  const renderer::FlipResult& flip = flip_of(report, metric);
  const renderer::FlipSummary& s = flip.summary;
  ordered_json json = {{"mean", s.mean},
                       {"weighted_median", s.weighted_median},
                       {"first_quartile", s.first_quartile},
                       {"third_quartile", s.third_quartile},
                       {"min", s.min},
                       {"max", s.max},
                       {"pixels_per_degree", report.flip_options.pixels_per_degree}};
  if (metric == Metric::flip) {
    json["exposure"] = report.flip_options.exposure;
    json["tonemap"] = enum_name(report.flip_options.tonemap);
  } else {
    json["start_exposure"] = flip.start_exposure;
    json["stop_exposure"] = flip.stop_exposure;
    json["exposures"] = flip.exposures;
  }
  return json;
}

std::string flip_text(const CompareReport& report, Metric metric) {
  const std::string name = renderer::name_of(kMetrics, metric);
  const renderer::FlipSummary& s = flip_of(report, metric).summary;
  return fmt::format("{:<16} {:.6g}, weighted quartiles {:.6g} {:.6g} {:.6g}, from {:.6g} to {:.6g}\n", name,
                     s.mean, s.first_quartile, s.weighted_median, s.third_quartile, s.min, s.max);
}

}  // namespace

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

std::string compare_json(const CompareReport& report) {
  ordered_json json = head_json(report);
  if (report.bias_rel_mse) {
    json["halves"] = {report.references.back(), report.tests.back()};
  }
  for (const Metric metric : report.metrics) {
    for (const ErrorValue& value : kErrorValues) {
      if (value.metric == metric) json[value.key] = json_number(report.errors.*value.member);
    }
    if (metric == Metric::psnr) json["psnr_peak"] = renderer::kPsnrPeak;
    if (metric == Metric::ssim) json["ssim"] = ssim_json(report);
    if (is_flip(metric)) json[renderer::name_of(kMetrics, metric)] = flip_json(report, metric);
  }
  if (report.bias_rel_mse) json["bias_rel_mse"] = json_number(*report.bias_rel_mse);
  return json_text(json) + "\n";
}

std::string compare_text(const CompareReport& report) {
  std::string text;
  for (const Metric metric : report.metrics) {
    for (const ErrorValue& value : kErrorValues) {
      if (value.metric != metric) continue;
      text += fmt::format("{:<16} {:.6g}{}\n", value.key, report.errors.*value.member,
                          metric == Metric::psnr ? " dB" : "");
    }
    if (metric == Metric::ssim)
      text += report.ssim ? fmt::format("{:<16} {:.6g}\n", "ssim", *report.ssim) : "ssim             -\n";
    if (is_flip(metric)) text += flip_text(report, metric);
  }
  if (report.bias_rel_mse) text += fmt::format("{:<16} {:.6g}\n", "bias_rel_mse", *report.bias_rel_mse);
  return text;
}

}  // namespace gatelight::apps

#include "renderer/compare.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/errors.h"
#include "apps/log.h"
#include "apps/results.h"
#include "apps/subcommand.h"
#include "apps/values.h"
#include "renderer/image_read.h"
#include "renderer/image_write.h"

namespace gatelight::apps {
namespace {

using renderer::ErrorMetrics;

constexpr const char* kFooter = R"(Over the red, green and blue of the beauty layers:
  mse      mean squared error
  rel_mse  mean of the squared error over (squared reference + 0.01)
  psnr     peak signal to noise ratio in dB, for a peak of 1
  mean     mean of the absolute difference, and of the signed one (test minus reference)
  max      largest absolute difference
Pixels that are not finite in one of the pictures are counted and left out. PNG files are made linear first.

Examples:
  gatelight compare reference.exr test.exr
  gatelight compare reference.exr test.exr --metric rel_mse --json - --error-map error.png)";

struct CompareSettings {
  std::string reference;
  std::string test;
  std::string metrics;
  std::string json;
  std::string error_map;
};

struct Metric {
  std::string_view name;                                               ///< in --metric
  std::vector<std::pair<const char*, double ErrorMetrics::*>> values;  ///< by their keys in the JSON
};

const std::vector<Metric>& all_metrics() {
  static const std::vector<Metric> metrics = {
      {"mse", {{"mse", &ErrorMetrics::mse}}},
      {"rel_mse", {{"rel_mse", &ErrorMetrics::rel_mse}}},
      {"psnr", {{"psnr", &ErrorMetrics::psnr}}},
      {"mean",
       {{"mean_error", &ErrorMetrics::mean_error}, {"mean_difference", &ErrorMetrics::mean_difference}}},
      {"max", {{"max_error", &ErrorMetrics::max_error}}},
  };
  return metrics;
}

std::vector<const Metric*> choose_metrics(const std::string& list) {
  std::vector<const Metric*> chosen;
  std::vector<std::string_view> names;
  for (const Metric& metric : all_metrics()) {
    names.push_back(metric.name);
    if (list.empty()) chosen.push_back(&metric);
  }
  if (list.empty()) return chosen;
  for (const std::string& word : split_list("--metric", list)) {
    const auto found = std::find(names.begin(), names.end(), word);
    if (found == names.end()) refuse_choice("--metric", word, join_names(names));
    chosen.push_back(&all_metrics()[static_cast<std::size_t>(found - names.begin())]);
  }
  return chosen;
}

std::string as_json(const CompareSettings& settings, const std::vector<const Metric*>& metrics,
                    const renderer::Picture& reference, const ErrorMetrics& result) {
  nlohmann::ordered_json json = {
      {"schema", 1},
      {"reference", settings.reference},
      {"test", settings.test},
      {"width", reference.width},
      {"height", reference.height},
      {"pixels", result.pixels},
      {"nonfinite", {{"reference", result.nonfinite_reference}, {"test", result.nonfinite_test}}}};
  for (const Metric* metric : metrics) {
    for (const auto& [key, member] : metric->values) {
      // Equal pictures have an infinite PSNR, which JSON cannot say: null.
      json[key] = std::isfinite(result.*member) ? nlohmann::ordered_json(result.*member) : nullptr;
    }
    if (metric->name == "psnr") json["psnr_peak"] = renderer::kPsnrPeak;
  }
  return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string as_text(const std::vector<const Metric*>& metrics, const ErrorMetrics& result) {
  std::string text;
  for (const Metric* metric : metrics) {
    for (const auto& [key, member] : metric->values) {
      text += fmt::format("{:<16} {:.6g}{}\n", key, result.*member, metric->name == "psnr" ? " dB" : "");
    }
  }
  return text;
}

int run_compare(const CompareSettings& settings) {
  const std::vector<const Metric*> metrics = choose_metrics(settings.metrics);
  if (!settings.error_map.empty()) {
    if (std::filesystem::path(settings.error_map).extension() != ".png") {
      throw UsageError(fmt::format("--error-map: '{}' is not a .png file", settings.error_map));
    }
    renderer::check_image_output(settings.error_map);
  }
  if (!settings.json.empty() && settings.json != "-") renderer::check_writable(settings.json);

  const renderer::Picture reference = renderer::read_image(settings.reference);
  const renderer::Picture test = renderer::read_image(settings.test);
  const renderer::NamedPicture named_reference{reference, settings.reference};
  const renderer::NamedPicture named_test{test, settings.test};
  const ErrorMetrics result = renderer::compare_pictures(named_reference, named_test);
  if (result.nonfinite_reference + result.nonfinite_test > 0) {
    log_warning(fmt::format("pixels that are not finite: {} in '{}', {} in '{}'; they are left out",
                            result.nonfinite_reference, settings.reference, result.nonfinite_test,
                            settings.test));
  }
  if (!settings.error_map.empty()) {
    renderer::write_image(renderer::error_map(named_reference, named_test), settings.error_map);
  }
  if (!settings.json.empty()) write_text(settings.json, as_json(settings, metrics, reference, result));
  // JSON on stdout stands alone, so that it can be parsed.
  if (settings.json != "-") write_text("-", as_text(metrics, result));
  return kDone;
}

}  // namespace

Subcommand add_compare_command(CLI::App& root) {
  CLI::App* app = root.add_subcommand("compare", "Measure how far one picture is from another");
  app->footer(kFooter);
  const auto settings = std::make_shared<CompareSettings>();
  app->add_option("REFERENCE", settings->reference, "Reference picture, .exr, .hdr or .png")
      ->required()
      ->type_name("");
  app->add_option("TEST", settings->test, "Picture to be judged")->required()->type_name("");
  app->add_option("--metric", settings->metrics,
                  "Which, separated by commas: mse,rel_mse,psnr,mean,max (default: all)")
      ->type_name("LIST");
  app->add_option("--json", settings->json, "Result as JSON; - is stdout")->type_name("FILE|-");
  app->add_option("--error-map", settings->error_map,
                  "Picture of the relative error: black 0, violet 0.1, red 0.25, yellow 0.5, white 1 and "
                  "more, green not finite")
      ->type_name("FILE.png");
  return {app, [settings] { return run_compare(*settings); }};
}

}  // namespace gatelight::apps

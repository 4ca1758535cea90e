#pragma once
// The results of `compare` as text and as JSON.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/settings/parsing.h"
#include "renderer/metrics/compare.h"
#include "renderer/metrics/flip.h"

namespace gatelight::apps {

enum class Metric : std::uint8_t { mse, rel_mse, psnr, mean, max, ssim, flip, hdr_flip, temporal };

inline constexpr renderer::Choice<Metric> kMetrics[] = {
    {"mse", Metric::mse},   {"rel_mse", Metric::rel_mse},   {"psnr", Metric::psnr},
    {"mean", Metric::mean}, {"max", Metric::max},           {"ssim", Metric::ssim},
    {"flip", Metric::flip}, {"hdr_flip", Metric::hdr_flip}, {"temporal", Metric::temporal}};

/// The metrics that are plain numbers, with their keys in the JSON.
struct ErrorValue {
  Metric metric;
  const char* key;
  double renderer::ErrorMetrics::*member;
};
inline constexpr ErrorValue kErrorValues[] = {
    {Metric::mse, "mse", &renderer::ErrorMetrics::mse},
    {Metric::rel_mse, "rel_mse", &renderer::ErrorMetrics::rel_mse},
    {Metric::psnr, "psnr", &renderer::ErrorMetrics::psnr},
    {Metric::mean, "mean_error", &renderer::ErrorMetrics::mean_error},
    {Metric::mean, "mean_difference", &renderer::ErrorMetrics::mean_difference},
    {Metric::max, "max_error", &renderer::ErrorMetrics::max_error}};

struct CompareReport {
  std::vector<std::string> references;  ///< files: one, or two halves
  std::vector<std::string> tests;
  int width = 0;
  int height = 0;
  std::vector<Metric> metrics;  ///< requested, in the order of the report
  renderer::ErrorMetrics errors;
  renderer::FlipOptions flip_options;  ///< exposure and curve also of ssim
  std::optional<double> ssim;          ///< empty: not requested, or the picture is smaller than the window
  std::optional<renderer::FlipResult> flip;  ///< present where requested, as hdr_flip is
  std::optional<renderer::FlipResult> hdr_flip;
  std::optional<double> bias_rel_mse;  ///< of halves
};

/// What both the report of two pictures and that of frames begin with.
nlohmann::ordered_json head_json(const CompareReport& report);

std::string compare_text(const CompareReport& report);
std::string compare_json(const CompareReport& report);

}  // namespace gatelight::apps

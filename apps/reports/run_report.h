#pragma once
// The report of a run as text and as JSON.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/settings/render_settings.h"
#include "renderer/settings/statistics.h"

namespace gatelight::apps {

struct RunReport {
  std::vector<std::string> command;
  renderer::RenderStatistics statistics;
  double load_seconds = 0.0;
  double write_seconds = 0.0;
  double total_seconds = 0.0;
  float exposure = 0.0f;  ///< of the PNG files, in stops
  std::vector<std::string> warnings;
  int signal = 0;            ///< signal that stopped the run; 0: none
  std::string team_summary;  ///< a line about the processes, where there are several
  nlohmann::ordered_json team_json = nlohmann::ordered_json::object();  ///< for the statistics file
};

/// Largest resident memory of this process so far, in bytes.
std::size_t peak_resident_bytes();

/// The statistics file (schema 1), one JSON object with a line break at its end.
std::string stats_json(RenderSettings settings, const RunReport& report);

/// A few lines, each with its line break.
std::string summary(const RenderSettings& settings, const RunReport& report);

/// The numbers of the summary, for the last event of --progress json.
nlohmann::ordered_json summary_json(const RenderSettings& settings, const RunReport& report);

/// "spp", "max-error", "time-limit", "signal" or "device".
std::string word_of(renderer::EndedBy end);

/// The notice after a signal: the progress, also of training where that was cut short, and what was written.
std::string stop_notice(const RenderSettings& settings, const RunReport& report);

/// One line for a finished frame of an animation.
std::string frame_line(int frame, const RenderSettings& settings, const RunReport& report);

/// The lines after the last frame.
std::string frames_summary(std::size_t frames, double seconds, const RunReport& report);

}  // namespace gatelight::apps

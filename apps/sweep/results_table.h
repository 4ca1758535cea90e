#pragma once
// The tables of a sweep, and results.md.

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace gatelight::apps {

/// Texts in rows, which results.md and report.html show.
struct TextTable {
  std::vector<std::string> head;
  std::size_t first_number = 0;  ///< the columns from this one on hold numbers
  std::vector<std::vector<std::string>> rows;
};

/// Means over the seeds: a row for each scene, with named runs beside denoised paths. Without named runs it
/// has no rows.
TextTable trade_table(const nlohmann::ordered_json& results);
/// Means over the seeds: a row for each run and number of steps or samples.
TextTable runs_table(const nlohmann::ordered_json& results);
/// What the columns of both mean.
extern const char* const kTableLegend;

/// Both as Markdown.
std::string results_table(const nlohmann::ordered_json& results);

}  // namespace gatelight::apps

#pragma once
// The record of a cell: the JSON object of cells/ID.json and results.json.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/reports/compare_report.h"
#include "apps/sweep/planned.h"
#include "renderer/settings/statistics.h"

namespace gatelight::apps {

/// Increases when a key changes its meaning or disappears.
inline constexpr int kSweepSchema = 2;

/// A cell in its plan.
struct CellPlace {
  const PlannedScene& scene;
  const PlannedSeries& series;
  std::uint32_t seed = 0;
  int point = 0;  ///< training steps, or samples without a cache
  std::string id;
  std::string reference_key;  ///< of its reference
};

/// The record without results. Its keys replace those of a record that was read, because labels and axes
/// belong to the sweep, not to the cell.
nlohmann::ordered_json planned_record(const CellPlace& place);
nlohmann::ordered_json failed_record(const CellPlace& place, const std::string& error);
/// pictures: whether they are written. ao_distance: resolved, in metres.
nlohmann::ordered_json done_record(const CellPlace& place, const renderer::RenderStatistics& statistics,
                                   const CompareReport& errors, bool pictures, float ao_distance);

/// Whether the record has results. False for null and for other JSON.
bool is_done(const nlohmann::ordered_json& record);

/// File names relative to the sweep's folder.
std::string picture_file(const std::string& id);
std::string error_map_file(const std::string& id);
std::string exr_file(const std::string& id);
std::string cell_file(const std::string& id);

/// Reads the record of a cell and updates it with the plan. Returns nothing where the cell is not done, or
/// its file cannot be read or has another schema.
std::optional<nlohmann::ordered_json> read_done_record(const std::string& folder, const CellPlace& place,
                                                       bool with_pictures);

}  // namespace gatelight::apps

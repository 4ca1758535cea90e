#pragma once
// What is known of a cell, as the JSON object of cells/ID.json and results.json.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/sweep/measure.h"
#include "apps/sweep/planned.h"
#include "renderer/settings/statistics.h"

namespace gatelight::apps {

/// Rises when a key changes its meaning or goes away.
inline constexpr int kSweepSchema = 2;

/// A cell in its plan.
struct CellPlace {
  const PlannedScene& scene;
  const PlannedSeries& series;
  std::uint32_t seed = 0;
  int point = 0;  ///< training steps, or samples of a plain integrator
  std::string id;
  std::string reference_key;  ///< of what it is compared with
};

/// Without results: what the plan says of it. Written anew over a record that was read, because labels and
/// axes belong to the sweep, not to the cell.
nlohmann::ordered_json planned_record(const CellPlace& place);
nlohmann::ordered_json failed_record(const CellPlace& place, const std::string& error);
/// pictures: whether they are written under their names. ao_distance: the one that the options mean.
nlohmann::ordered_json done_record(const CellPlace& place, const renderer::RenderStatistics& statistics,
                                   const CellErrors& errors, bool pictures, float ao_distance);

/// False for null, and for what is no record.
bool is_done(const nlohmann::ordered_json& record);

/// Relative to the sweep's folder.
std::string picture_file(const std::string& id);
std::string error_map_file(const std::string& id);
std::string cell_file(const std::string& id);

/// The record of the file with what the plan says today; of a cell that is not done, a file that cannot be
/// read, or one of another schema, nothing.
std::optional<nlohmann::ordered_json> read_done_record(const std::string& folder, const CellPlace& place,
                                                       bool with_pictures);

}  // namespace gatelight::apps

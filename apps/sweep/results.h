#pragma once
// results.json and results.csv: all cells of a sweep.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace gatelight::apps {

struct SceneResults {  // NOLINT(bugprone-exception-escape): moving JSON throws nothing, though it could
  nlohmann::ordered_json scene;  ///< {"name", "file", "references"}
  std::vector<nlohmann::ordered_json> cells;
};

/// Collects all cells. Machine and versions are those that the cells name, which need not be this program's.
nlohmann::ordered_json make_results(const std::vector<std::string>& command,
                                    const std::vector<SceneResults>& scenes);

/// The value of a column of results.csv: "seconds_train" is {"seconds": {"train": 1}}. Null where a cell has
/// none.
const nlohmann::ordered_json* find_value(const nlohmann::ordered_json& cell, const std::string& column);

/// CSV with a line for each cell. The columns are the flattened keys of results.json, the same for all
/// sweeps, and one for each axis. Null is empty. Texts are quoted as in RFC 4180.
std::string results_csv(const nlohmann::ordered_json& results);

/// DIR/results.json.
std::string results_file(const std::string& folder);
/// Throws InputError. The cells are not checked.
nlohmann::ordered_json read_results(const std::string& folder);

}  // namespace gatelight::apps

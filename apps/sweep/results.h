#pragma once
// results.json and results.csv: all cells of a sweep.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace gatelight::apps {

/// Rises when a key changes its meaning or goes away.
inline constexpr int kSweepSchema = 1;

/// Of this machine: {"cpu", "threads", "isa"}.
nlohmann::ordered_json machine_json(int threads);

struct SceneResults {
  nlohmann::ordered_json scene;  ///< {"name", "file", "references"}
  std::vector<nlohmann::ordered_json> cells;
};

nlohmann::ordered_json make_results(const std::vector<std::string>& command, int threads,
                                    const std::vector<SceneResults>& scenes);

/// A line for each cell, flat columns with the names of results.json's keys; what is null there is empty.
/// Texts are quoted as in RFC 4180.
std::string results_csv(const nlohmann::ordered_json& results);

/// Reads DIR/results.json. Throws InputError.
nlohmann::ordered_json read_results(const std::string& folder);

}  // namespace gatelight::apps

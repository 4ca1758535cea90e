#include "apps/sweep/results.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "apps/errors.h"
#include "apps/version.h"
#include "renderer/accel.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(':');
    if (line.rfind("model name", 0) != 0 || colon == std::string::npos) continue;
    const std::size_t begin = line.find_first_not_of(' ', colon + 1);
    return begin == std::string::npos ? "" : line.substr(begin);
  }
  return "unknown";
}

std::string csv_field(const ordered_json& value) {
  if (value.is_null()) return "";
  const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

/// The keys of one level, and of objects in them: "seconds_train".
void flatten(const ordered_json& object, const std::string& prefix, ordered_json& flat) {
  for (const auto& [key, value] : object.items()) {
    if (key == "options" || (prefix.empty() && key == "axes")) continue;
    if (value.is_object()) {
      flatten(value, prefix + key + "_", flat);
    } else {
      flat[prefix + key] = value;
    }
  }
}

ordered_json flat_row(const ordered_json& cell) {
  ordered_json row;
  flatten(cell, "", row);
  for (const auto& [axis, value] : cell.at("axes").items()) row["axis_" + axis] = value;
  return row;
}

}  // namespace

ordered_json machine_json(int threads) {
  return {{"cpu", cpu_name()}, {"threads", threads}, {"isa", renderer::best_isa()}};
}

ordered_json make_results(const std::vector<std::string>& command, int threads,
                          const std::vector<SceneResults>& scenes) {
  ordered_json results = {{"schema", kSweepSchema},
                          {"version", version()},
                          {"command", command},
                          {"machine", machine_json(threads)},
                          {"scenes", ordered_json::array()},
                          {"cells", ordered_json::array()}};
  for (const SceneResults& scene : scenes) {
    results["scenes"].push_back(scene.scene);
    for (const ordered_json& cell : scene.cells) results["cells"].push_back(cell);
  }
  return results;
}

std::string results_csv(const ordered_json& results) {
  // A failed cell has null where others have an object.
  std::set<std::string> objects;
  for (const ordered_json& cell : results.at("cells")) {
    for (const auto& [key, value] : cell.items()) {
      if (value.is_object()) objects.insert(key);
    }
  }
  std::vector<ordered_json> rows;
  std::vector<std::string> columns;
  std::set<std::string> known = objects;
  for (const ordered_json& cell : results.at("cells")) {
    rows.push_back(flat_row(cell));
    for (const auto& [key, value] : rows.back().items()) {
      if (known.insert(key).second) columns.push_back(key);
    }
  }
  std::string text;
  for (const std::string& column : columns) text += (text.empty() ? "" : ",") + column;
  text += "\n";
  for (const ordered_json& row : rows) {
    bool first = true;
    for (const std::string& column : columns) {
      if (!first) text += ',';
      first = false;
      if (row.contains(column)) text += csv_field(row[column]);
    }
    text += "\n";
  }
  return text;
}

ordered_json read_results(const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / "results.json").string();
  std::ifstream file(path);
  if (!file) {
    throw InputError(
        fmt::format("cannot read '{}': there is no sweep in this folder, expected one that has "
                    "been made with --output",
                    path));
  }
  ordered_json results = ordered_json::parse(file, nullptr, false);
  if (!results.is_object() || !results.contains("cells") || !results.contains("schema")) {
    throw InputError(fmt::format("cannot read '{}': it is no result of a sweep", path));
  }
  if (results["schema"] != kSweepSchema) {
    throw InputError(fmt::format("cannot read '{}': its schema is {}, expected {}", path,
                                 results["schema"].dump(), kSweepSchema));
  }
  return results;
}

}  // namespace gatelight::apps

#include "apps/sweep/results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "apps/reports/json.h"
#include "apps/settings/parsing.h"
#include "apps/sweep/cell_record.h"
#include "apps/sweep/identity.h"
#include "apps/sweep/measured_runs.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/version.h"
#include "base/platform/threads.h"
#include "renderer/surface/embree.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

/// Columns of all sweeps, so that programs can rely on them; axes follow.
constexpr const char* kColumns =
    "id,scene,series,run,integrator,encoding,seed,train_steps,spp,reference,reference_id,command,status,"
    "error,"
    "version,cpu,isa,backend,seconds_scout,seconds_setup,seconds_train,seconds_train_trace,"
    "seconds_train_query,seconds_train_step,seconds_render,seconds_denoise,seconds_total,"
    "train_ms_per_step,train_step_ms,query_ms_per_2m,memory_bytes_parameters,memory_bytes_optimizer,"
    "memory_bytes_layout,loss,errors_mse,errors_rel_mse,errors_rel_mse_clean,errors_bias_rel_mse,errors_psnr,"
    "errors_ssim,"
    "errors_flip,errors_hdr_flip,flip_percentiles_q25,flip_percentiles_median,flip_percentiles_q75,"
    "estimated_error,picture,error_map,equal_seconds_rel_mse_clean,equal_seconds_flip,"
    "equal_seconds_denoised_rel_mse_clean,equal_seconds_denoised_flip,times_faster_rel_mse_clean,"
    "times_faster_flip,times_faster_denoised_rel_mse_clean,times_faster_denoised_flip,"
    "extrapolated_rel_mse_clean,extrapolated_flip,extrapolated_denoised_rel_mse_clean,"
    "extrapolated_denoised_flip";

std::string csv_field(const ordered_json& value) {
  if (value.is_null()) return "";
  std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

/// The distinct values of `key` in the cells.
std::set<std::string> words_of_cells(const ordered_json& cells, const char* key) {
  std::set<std::string> words;
  for (const ordered_json& cell : cells) {
    if (is_done(cell)) words.insert(cell.at(key).get<std::string>());
  }
  return words;
}

/// The machine that the cells name; this machine where no cell is done.
ordered_json machine_json(const ordered_json& cells) {
  int threads = 0;
  for (const ordered_json& cell : cells) {
    if (is_done(cell)) threads = std::max(threads, cell.at("options").at("threads").get<int>());
  }
  const std::set<std::string> isas = words_of_cells(cells, "isa");
  return {{"cpu", cpu_name()},
          {"threads", threads > 0 ? threads : available_threads()},
          {"isa", isas.empty() ? renderer::best_isa() : fmt::format("{}", fmt::join(isas, ", "))}};
}

}  // namespace

ordered_json make_results(const std::vector<std::string>& command, const std::vector<SceneResults>& scenes) {
  ordered_json results = {{"schema", kSweepSchema},
                          {"version", version()},
                          {"command", command},
                          {"machine", nullptr},
                          {"versions", {{"gatelight", version()}, {"embree", renderer::embree_version()}}},
                          {"scenes", ordered_json::array()},
                          {"cells", ordered_json::array()}};
  for (const SceneResults& scene : scenes) {
    results["scenes"].push_back(scene.scene);
    for (const ordered_json& cell : scene.cells) results["cells"].push_back(cell);
  }
  add_equal_error(results["cells"]);
  results["machine"] = machine_json(results["cells"]);
  results["versions"]["of_cells"] = words_of_cells(results["cells"], "version");
  return results;
}

const ordered_json* find_value(const ordered_json& cell, const std::string& column) {
  if (const auto at = cell.find(column); at != cell.end()) return &*at;
  for (const auto& [key, value] : cell.items()) {
    if (!value.is_object() || column.rfind(key + "_", 0) != 0) continue;
    const auto at = value.find(column.substr(key.size() + 1));
    if (at != value.end()) return &*at;
  }
  return nullptr;
}

std::string results_csv(const ordered_json& results) {
  const std::vector<std::string> columns = split_list("columns", kColumns);
  std::vector<std::string> axes;
  for (const ordered_json& cell : results.at("cells")) {
    for (const auto& [axis, value] : cell.at("axes").items()) {
      if (std::find(axes.begin(), axes.end(), axis) == axes.end()) axes.push_back(axis);
    }
  }
  std::string text = kColumns;
  for (const std::string& axis : axes) text += ",axis_" + axis;
  text += "\n";
  for (const ordered_json& cell : results["cells"]) {
    std::vector<std::string> fields;
    for (const std::string& column : columns) {
      const ordered_json* value = find_value(cell, column);
      fields.push_back(value ? csv_field(*value) : "");
    }
    for (const std::string& axis : axes)
      fields.push_back(csv_field(cell["axes"].value(axis, ordered_json())));
    text += fmt::format("{}\n", fmt::join(fields, ","));
  }
  return text;
}

std::string results_file(const std::string& folder) {
  return (std::filesystem::path(folder) / "results.json").string();
}

ordered_json read_results(const std::string& folder) {
  const std::string path = results_file(folder);
  std::ifstream file(path);
  if (!file) {
    throw InputError(fmt::format(
        "cannot read '{}': there is no sweep in this folder, expected the --output of a sweep", path));
  }
  ordered_json results = read_json_file(path);
  if (!results.is_object() || !results.contains("schema") || !results["cells"].is_array()) {
    throw InputError(fmt::format("cannot read '{}': it is not the result of a sweep", path));
  }
  if (results["schema"] != kSweepSchema) {
    throw InputError(fmt::format("cannot read '{}': its schema is {}, expected {}", path,
                                 results["schema"].dump(), kSweepSchema));
  }
  return results;
}

}  // namespace gatelight::apps

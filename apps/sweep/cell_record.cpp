#include "apps/sweep/cell_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "apps/reports/cache_statistics.h"
#include "apps/reports/json.h"
#include "apps/reports/recipe.h"
#include "apps/settings/option.h"
#include "apps/sweep/identity.h"
#include "apps/sweep/planned.h"
#include "apps/terminal/text.h"
#include "apps/terminal/version.h"
#include "base/image/png_read.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using renderer::CacheStatistics;

constexpr double kFullHdPixels = 1920.0 * 1080.0;

ordered_json per(double seconds, double count) {
  return count > 0.0 ? ordered_json(seconds / count) : nullptr;
}

ordered_json seconds_json(const renderer::RenderStatistics& s, bool has_cache) {
  const CacheStatistics& c = s.cache;
  ordered_json json = cache_seconds_json(c);
  if (!has_cache) {
    for (ordered_json& value : json) value = nullptr;
  }
  json["render"] = s.render_seconds;
  json["denoise"] = s.denoise_seconds > 0.0 ? ordered_json(s.denoise_seconds) : nullptr;
  const double before = has_cache ? c.scout_seconds + c.setup_seconds + c.train_seconds : 0.0;
  json["total"] = before + s.render_seconds + s.denoise_seconds;
  return json;
}

void add_speed(ordered_json& json, const CacheStatistics& c, bool has_cache) {
  json["train_ms_per_step"] = has_cache ? per(1e3 * c.train_seconds, c.steps) : nullptr;
  json["train_step_ms"] = has_cache ? per(1e3 * c.train_step_seconds, c.steps) : nullptr;
  json["query_ms_per_2m"] =
      has_cache ? per(1e3 * kFullHdPixels * c.render_query_seconds, static_cast<double>(c.queries)) : nullptr;
  json["memory_bytes"] = has_cache ? cache_memory_json(c) : nullptr;
  json["loss"] = has_cache ? json_number(c.loss) : nullptr;
}

void add_errors(ordered_json& json, const CompareReport& e) {
  json["errors"] = {{"mse", json_number(e.errors.mse)},
                    {"rel_mse", json_number(e.errors.rel_mse)},
                    {"rel_mse_clean", json_number(e.rel_mse_clean)},
                    {"bias_rel_mse", json_number(e.bias_rel_mse)},
                    {"psnr", json_number(e.errors.psnr)},
                    {"ssim", json_number(e.ssim)},
                    {"flip", e.flip ? json_number(e.flip->summary.mean) : nullptr},
                    {"hdr_flip", e.hdr_flip ? json_number(e.hdr_flip->summary.mean) : nullptr}};
  if (!e.flip) {
    json["flip_percentiles"] = nullptr;
    return;
  }
  const renderer::FlipSummary& s = e.flip->summary;
  json["flip_percentiles"] = {
      {"q25", s.first_quartile}, {"median", s.weighted_median}, {"q75", s.third_quartile}};
}

/// The keys that only a measured picture has.
constexpr const char* kMeasured[] = {
    "seconds", "train_ms_per_step", "train_step_ms", "query_ms_per_2m", "memory_bytes",   "loss",
    "errors",  "flip_percentiles",  "picture",       "error_map",       "estimated_error"};

/// Options whose value the run may choose.
constexpr const char* kFoundOptions[] = {"isa",          "filter-width", "ao-distance", "direction-input",
                                         "normal-input", "albedo-input", "node-spacing"};

/// What a named run decides itself, with its integrator and its steps.
constexpr const char* kOfNamedRun[] = {"integrator", "encoding", "train_steps", "spp", "options"};

ordered_json found_number(float value) {
  if (std::isinf(value)) return "inf";
  return shortest(value);
}

/// Sets the values that the run has chosen; options that do not apply stay out.
void add_found(ordered_json& options, const CellPlace& place, const renderer::RenderStatistics& s,
               float ao_distance) {
  const renderer::RenderOptions& o = place.series.settings.render;
  options["isa"] = s.isa;
  options["filter-width"] = found_number(renderer::resolve_filter_width(o.filter, o.filter_width));
  if (place.series.reference == ReferenceKind::ao) options["ao-distance"] = found_number(ao_distance);
  const auto set = [&](const char* key, const ordered_json& value) {
    if (options.contains(key)) options[key] = value;
  };
  set("direction-input", renderer::name_of(kOnOff, s.cache.direction_input));
  set("normal-input", renderer::name_of(kOnOff, s.cache.normal_input));
  set("albedo-input", renderer::name_of(kOnOff, s.cache.albedo_input));
  set("node-spacing", found_number(s.cache.node_spacing));
}

/// Adds program version and machine, without which times mean little.
void add_origin(ordered_json& json) {
  json["schema"] = kSweepSchema;
  json["version"] = version();
  json["cpu"] = cpu_name();
  json["isa"] = nullptr;
  json["backend"] = nullptr;
}

/// Whether it is an object of numbers or nulls; JSON has null for numbers that are not finite.
bool holds_numbers(const ordered_json& object) {
  return object.is_object() && std::all_of(object.begin(), object.end(), [](const ordered_json& value) {
           return value.is_null() || value.is_number();
         });
}

/// Whether the record has all keys, with the types that the program relies on.
bool is_whole(const ordered_json& record) {
  for (const char* key : kMeasured) {
    if (!record.contains(key)) return false;
  }
  for (const char* key : {"version", "cpu", "isa"}) {
    if (!record.contains(key) || !record[key].is_string()) return false;
  }
  for (const char* key :
       {"train_ms_per_step", "train_step_ms", "query_ms_per_2m", "loss", "estimated_error"}) {
    if (!record[key].is_null() && !record[key].is_number()) return false;
  }
  for (const char* key : {"memory_bytes", "flip_percentiles"}) {
    if (!record[key].is_null() && !holds_numbers(record[key])) return false;
  }
  const ordered_json& seconds = record["seconds"];
  return holds_numbers(record["errors"]) && record["errors"].contains("flip") && holds_numbers(seconds) &&
         seconds.contains("total") && seconds["total"].is_number() && seconds["total"] >= 0.0;
}

/// Whether the file is complete; after a power failure it may not be.
bool is_whole_png(const std::filesystem::path& path) {
  try {
    open_png(path).read_8();
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

}  // namespace

ordered_json planned_record(const CellPlace& place) {
  const PlannedSeries& series = place.series;
  const renderer::RenderOptions& o = series.settings.render;
  const bool has_cache = series.has_cache();
  ordered_json axes = ordered_json::object();
  for (const auto& [name, value] : series.axes) axes[name] = value;
  RenderSettings settings = cell_settings(series, place.scene.file, place.seed, place.point);
  return {{"id", place.id},
          {"scene", place.scene.name},
          {"series", series.label},
          {"run", run_name(series, place.point)},
          {"integrator", renderer::enum_name(o.integrator)},
          {"encoding", has_cache ? ordered_json(renderer::enum_name(o.cache.encoding)) : nullptr},
          {"axes", axes},
          {"seed", place.seed},
          {"train_steps", has_cache && !series.named ? ordered_json(place.point) : nullptr},
          {"spp", has_cache || series.named ? o.spp : place.point},
          {"options", resolved_options(settings)},
          {"reference", renderer::name_of(kReferenceKinds, series.reference)},
          {"reference_id", place.reference_key},
          {"command", cell_command(series, place.scene.file, place.seed, place.point)}};
}

ordered_json failed_record(const CellPlace& place, const std::string& error) {
  ordered_json json = planned_record(place);
  json["status"] = "failed";
  json["error"] = error;
  add_origin(json);
  for (const char* key : kMeasured) json[key] = nullptr;
  return json;
}

ordered_json done_record(const CellPlace& place, const renderer::RenderStatistics& statistics,
                         const CompareReport& errors, bool pictures, float ao_distance) {
  const bool has_cache = place.series.has_cache();
  ordered_json json = planned_record(place);
  json["status"] = "done";
  json["error"] = nullptr;
  add_origin(json);
  json["isa"] = statistics.isa;
  if (has_cache) json["backend"] = statistics.cache.backend;
  if (has_cache && place.series.named) {
    json["train_steps"] = statistics.cache.steps;
    json["options"]["train-steps"] = statistics.cache.steps;
  }
  add_found(json["options"], place, statistics, ao_distance);
  json["seconds"] = seconds_json(statistics, has_cache);
  add_speed(json, statistics.cache, has_cache);
  add_errors(json, errors);
  json["estimated_error"] =
      statistics.estimated_error > 0.0 ? json_number(*statistics.estimated_error) : nullptr;
  json["picture"] = pictures ? ordered_json(picture_file(place.id)) : nullptr;
  json["error_map"] = pictures && errors.flip ? ordered_json(error_map_file(place.id)) : nullptr;
  return json;
}

bool is_done(const ordered_json& record) {
  const auto status = record.is_object() ? record.find("status") : record.end();
  return status != record.end() && *status == "done";
}

std::string picture_file(const std::string& id) {
  return "pictures/" + id + ".png";
}
std::string error_map_file(const std::string& id) {
  return "pictures/" + id + "-flip.png";
}
std::string exr_file(const std::string& id) {
  return "pictures/" + id + ".exr";
}
std::string cell_file(const std::string& id) {
  return "cells/" + id + ".json";
}

std::optional<ordered_json> read_done_record(const std::string& folder, const CellPlace& place,
                                             bool with_pictures) {
  const std::filesystem::path root = folder;
  ordered_json record = read_json_file(root / cell_file(place.id));
  if (!is_done(record) || record["id"] != place.id || record["schema"] != kSweepSchema || !is_whole(record))
    return std::nullopt;
  // The files may have been deleted since. No files of other names are shown.
  const std::pair<const char*, std::string> files[] = {{"picture", picture_file(place.id)},
                                                       {"error_map", error_map_file(place.id)}};
  for (const auto& [key, file] : files) {
    if (record[key] == file && is_whole_png(root / file)) continue;
    if (with_pictures && key == files[0].first) return std::nullopt;
    record[key] = nullptr;
  }
  ordered_json planned = planned_record(place);
  for (const char* key : kOfNamedRun) {
    if (place.series.named && record.contains(key)) planned.erase(key);
  }
  const ordered_json& found = record["options"];
  for (const char* key : kFoundOptions) {
    if (planned.contains("options") && found.is_object() && found.contains(key))
      planned["options"][key] = found[key];
  }
  record.update(planned);
  return record;
}

}  // namespace gatelight::apps

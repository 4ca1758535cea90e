#include "apps/reports/recipe.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/reports/cache_recipe.h"
#include "apps/reports/json_values.h"
#include "apps/terminal/text.h"
#include "apps/terminal/version.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

/// JSON has no infinity.
ordered_json number(double value) {
  if (std::isinf(value)) return "inf";
  return value;
}

ordered_json environment(const renderer::EnvironmentOptions& options) {
  if (!options.file.empty()) return options.file;
  if (options.none()) return "none";
  return {options.constant.x(), options.constant.y(), options.constant.z()};
}

void add_camera(ordered_json& json, const renderer::CameraOptions& camera) {
  if (camera.look_at) {
    json["eye"] = triple(camera.look_at->eye);
    json["target"] = triple(camera.look_at->target);
    json["up"] = triple(camera.look_at->up);
  } else if (!camera.name.empty()) {
    json["camera"] = camera.name;
  }
  if (camera.fov_degrees) json["fov"] = *camera.fov_degrees;
}

}  // namespace

ordered_json resolved_options(const RenderSettings& settings) {
  const renderer::RenderOptions& o = settings.render;
  ordered_json json;
  json["integrator"] = name_of(integrator_choices(), o.integrator);
  json["size"] = {o.width, o.height};
  if (o.region) json["region"] = *o.region;
  json["spp"] = o.spp;
  json["time-limit"] = o.time_limit_seconds;
  json["max-depth"] = o.max_depth;
  json["min-depth"] = o.min_depth;
  json["seed"] = o.seed;
  json["sampler"] = name_of(sampler_choices(), o.sampler);
  json["filter"] = name_of(filter_choices(), o.filter);
  json["filter-width"] = o.filter_width;
  json["direct"] = name_of(direct_choices(), o.direct);
  json["mis"] = name_of(mis_choices(), o.mis);
  json["light-selection"] = name_of(light_selection_choices(), o.light_selection);
  json["clamp"] = o.clamp;
  if (o.ao_distance >= 0.0f) json["ao-distance"] = number(o.ao_distance);
  ordered_json aovs = ordered_json::array();
  for (const renderer::Aov aov : o.aovs) aovs.push_back(name_of(aov_choices(), aov));
  json["aov"] = aovs;
  json["nan"] = name_of(nan_choices(), o.nan_policy);
  json["isa"] = o.isa;
  add_camera(json, o.camera);
  json["environment"] = environment(o.environment);
  json["environment-rotation"] = o.environment.rotation_degrees;
  json["environment-scale"] = o.environment.scale;
  json["scene-index"] = settings.load.scene;
  json["variant"] = settings.load.variant;
  json["missing"] = settings.load.missing_is_error ? "error" : "warn";
  json["allow-external"] = settings.load.allow_external;
  json["exposure"] = settings.image.exposure;
  json["tonemap"] = name_of(tonemap_choices(), settings.image.tonemap);
  json["exr"] = settings.image.exr_float ? "float" : "half";
  if (renderer::uses_cache(o.integrator)) json.update(resolved_cache_options(settings));
  if (settings.reproducible) return json;
  json["threads"] = o.threads;
  json["memory-limit"] = o.memory_limit_bytes >> 20;
  json["output"] = settings.outputs;
  if (!o.checkpoint.file.empty()) {
    json["checkpoint"] = o.checkpoint.file;
    json["checkpoint-every"] = o.checkpoint.every_seconds;
    json["resume"] = o.checkpoint.resume;
  }
  return json;
}

std::string dump_options(const RenderSettings& settings) {
  // A file name need not be UTF-8; JSON must be.
  return resolved_options(settings).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::map<std::string, std::string> make_recipe(const RenderSettings& settings,
                                               const std::vector<std::string>& command,
                                               const renderer::RenderStatistics& statistics,
                                               double seconds_so_far) {
  std::map<std::string, std::string> recipe = {
      {"version", version()},
      {"scene", settings.scene},
      {"integrator", name_of(integrator_choices(), settings.render.integrator)},
      {"seed", std::to_string(settings.render.seed)},
      {"spp", std::to_string(statistics.spp)},
      {"isa", statistics.isa},
      {"options", dump_options(settings)},
  };
  if (!settings.reproducible) {
    recipe["command"] = quote_command(command);
    recipe["threads"] = std::to_string(statistics.threads);
    recipe["build_seconds"] = fmt::format("{:.3f}", statistics.build_seconds);
    recipe["render_seconds"] = fmt::format("{:.3f}", statistics.render_seconds);
    recipe["seconds"] = fmt::format("{:.3f}", seconds_so_far);
  }
  return recipe;
}

}  // namespace gatelight::apps

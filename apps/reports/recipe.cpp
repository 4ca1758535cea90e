#include "apps/reports/recipe.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/settings/complete_settings.h"
#include "apps/settings/option_table.h"
#include "apps/terminal/text.h"
#include "apps/terminal/version.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

/// The value of an option as JSON, which has no infinity.
struct Json {
  bool is_short;  ///< floats get their shortest digits

  ordered_json operator()(std::monostate) const { return nullptr; }
  ordered_json operator()(float value) const {
    if (std::isinf(value)) return "inf";
    return is_short ? shortest(value) : double{value};
  }
  template <class Value>
  ordered_json operator()(const Value& value) const {
    return value;
  }
};

}  // namespace

ordered_json resolved_options(RenderSettings settings) {
  const std::vector<Option> table = option_table(settings);
  const std::set<std::string> without_effect = options_without_effect(settings);
  ordered_json json;
  for (const Option& option : table) {
    const InRecipe in_recipe = option.marks.in_recipe;
    const bool said = settings.reproducible ? in_recipe == InRecipe::always : in_recipe != InRecipe::never;
    if (!said || without_effect.contains(option.name)) continue;
    const ordered_json value = std::visit(Json{option.marks.of_cache}, option.value());
    if (!value.is_null()) json[option.name] = value;
  }
  return json;
}

std::string dump_options(const RenderSettings& settings) {
  return json_text(resolved_options(settings), -1);
}

std::map<std::string, std::string> make_recipe(RenderSettings settings,
                                               const std::vector<std::string>& command,
                                               const renderer::RenderStatistics& statistics,
                                               double seconds_so_far) {
  renderer::use_device(settings.render, statistics.cache);
  std::map<std::string, std::string> recipe = {
      {"version", version()},
      {"scene", settings.scene},
      {"integrator", enum_name(settings.render.integrator)},
      {"seed", std::to_string(settings.render.seed)},
      {"spp", std::to_string(statistics.spp)},
      {"isa", statistics.isa},
      {"options", dump_options(settings)},
  };
  if (statistics.estimated_error)
    recipe["estimated_error"] = fmt::format("{:.6g}", *statistics.estimated_error);
  if (!statistics.denoiser.empty()) recipe["denoiser"] = statistics.denoiser;
  if (!settings.reproducible) {
    recipe["command"] = quote_command(command);
    recipe["threads"] = std::to_string(statistics.threads);
    recipe["build_seconds"] = fmt::format("{:.3f}", statistics.build_seconds);
    recipe["render_seconds"] = fmt::format("{:.3f}", statistics.render_seconds);
    recipe["seconds"] = fmt::format("{:.3f}", seconds_so_far);
  }
  return recipe;
}

ordered_json recipe_options(const renderer::Picture& picture) {
  const auto found = picture.metadata.find("options");
  if (found == picture.metadata.end()) return ordered_json(ordered_json::value_t::discarded);
  ordered_json json = ordered_json::parse(found->second, nullptr, false);
  return json.is_object() ? json : ordered_json(ordered_json::value_t::discarded);
}

}  // namespace gatelight::apps

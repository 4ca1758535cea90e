#include "apps/sweep/planned.h"

#include <fmt/format.h>

#include "apps/terminal/text.h"

namespace gatelight::apps {

std::string run_name(const PlannedSeries& series, int point) {
  if (series.named) return series.label;
  return fmt::format("{}, {} {}", series.label, point, series.has_cache() ? "steps" : "spp");
}

std::string named_text(const PlannedSeries& series) {
  const renderer::RenderOptions& o = series.settings.render;
  return series.named ? fmt::format("named {} {}\n", o.choose_integrator, o.spp_of_paths) : "";
}

RenderSettings cell_settings(const PlannedSeries& series, const std::string& scene, std::uint32_t seed,
                             int point) {
  RenderSettings settings = series.settings;
  settings.scene = scene;
  settings.render.seed = seed;
  if (series.named) return settings;
  if (series.has_cache()) {
    settings.render.cache.train_steps = point;
  } else {
    settings.render.spp = point;
  }
  return settings;
}

std::string cell_command(const PlannedSeries& series, const std::string& scene, std::uint32_t seed,
                         int point) {
  std::vector<std::string> words = {"gatelight", "render", scene};
  const std::vector<std::string> flags = words_of(series.flags);
  words.insert(words.end(), flags.begin(), flags.end());
  if (series.settings.load.allow_external) words.push_back("--allow-external");
  if (!series.named) {
    words.emplace_back(series.has_cache() ? "--train-steps" : "--spp");
    words.push_back(std::to_string(point));
  }
  words.insert(words.end(), {"--seed", std::to_string(seed), "-o", "out.exr"});
  return quote_command(words);
}

}  // namespace gatelight::apps

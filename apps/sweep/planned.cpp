#include "apps/sweep/planned.h"

#include "apps/terminal/text.h"

namespace gatelight::apps {

RenderSettings cell_settings(const PlannedSeries& series, const std::string& scene, std::uint32_t seed,
                             int point) {
  RenderSettings settings = series.settings;
  settings.scene = scene;
  settings.render.seed = seed;
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
  for (const std::string& word :
       {std::string(series.has_cache() ? "--train-steps" : "--spp"), std::to_string(point),
        std::string("--seed"), std::to_string(seed), std::string("-o"), std::string("out.exr")}) {
    words.push_back(word);
  }
  return quote_command(words);
}

}  // namespace gatelight::apps

#include "apps/sweep/scene_names.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <set>

#include "apps/terminal/errors.h"

namespace gatelight::apps {

std::vector<SweepScene> name_scenes(const std::vector<std::string>& files) {
  std::map<std::string, int> stems;
  std::set<std::filesystem::path> seen;
  for (const std::string& file : files) {
    const std::filesystem::path path = std::filesystem::absolute(file).lexically_normal();
    if (!seen.insert(path).second) {
      throw UsageError(fmt::format("SCENE: '{}' is named twice, expected different scenes", file));
    }
    ++stems[path.stem().string()];
  }
  std::vector<SweepScene> scenes;
  std::map<std::string, int> names;
  for (const std::string& file : files) {
    const std::filesystem::path path = std::filesystem::absolute(file).lexically_normal();
    std::string name = path.stem().string();
    if (stems[name] > 1) name = fmt::format("{}-{}", path.parent_path().filename().string(), name);
    const int count = ++names[name];
    if (count > 1) name += fmt::format("-{}", count);
    scenes.push_back({std::move(name), file, {}});
  }
  return scenes;
}

}  // namespace gatelight::apps

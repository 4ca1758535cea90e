#include "scene/object_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "base/nearest_word.h"
#include "scene/light_names.h"

namespace gatelight::scene {

ObjectNames::ObjectNames(const Scene& scene) {
  for (const Instance& instance : scene.instances) objects.insert(instance.name);
  for (const PunctualLight& light : scene.lights) lights.insert(light.name);
}

ErrorParts ObjectNames::no_such_object(const std::string& wanted, bool with_lights) const {
  std::vector<std::string> parts, all(objects.begin(), objects.end());
  if (!objects.empty()) parts.push_back(list_names("one of its objects", objects));
  if (with_lights) {
    if (!lights.empty()) parts.push_back(list_names("one of its lights", lights));
    parts.push_back(fmt::format("'{}'", kEnvironmentWord));
    all.insert(all.end(), lights.begin(), lights.end());
    all.emplace_back(kEnvironmentWord);
  }
  if (parts.empty()) parts = {"none: the file has no object"};
  return {.problem = fmt::format("there is no object '{}'", wanted),
          .expected = fmt::format("{}", fmt::join(parts, ", or ")),
          .hint = did_you_mean(wanted, all)};
}

}  // namespace gatelight::scene

#include "renderer/light/light_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "scene/light_names.h"

namespace gatelight::renderer {
namespace {

/// Finds the groups of names, and which names of the groups were found.
class Finder {
 public:
  explicit Finder(const std::vector<LightGroup>& groups) : groups_(groups) {
    for (const LightGroup& group : groups) used_.emplace_back(group.lights.size(), false);
  }

  /// The group of a light, or of the environment; the number of groups where none names it.
  std::size_t group_of(const std::string& name, bool environment = false) {
    std::size_t found = groups_.size();
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      for (std::size_t i = 0; i < groups_[g].lights.size(); ++i) {
        const std::string& wanted = groups_[g].lights[i];
        const bool fits = (wanted == kEnvironmentWord) == environment &&
                          (environment || scene::fits_light_name(wanted, name));
        if (!fits) continue;
        used_[g][i] = true;
        if (found != groups_.size() && found != g)
          throw BadOption(
              {"light-groups", name,
               fmt::format("is in the groups '{}' and '{}'", groups_[found].name, groups_[g].name),
               "it in one"});
        found = g;
      }
    }
    return found;
  }

  /// Throws for a name that was never found.
  void require_all(const scene::LightNames& names, bool environment) const {
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      for (std::size_t i = 0; i < groups_[g].lights.size(); ++i) {
        if (used_[g][i]) continue;
        const std::string& wanted = groups_[g].lights[i];
        if (wanted == kEnvironmentWord)
          throw BadOption({"light-groups", groups_[g].name, "has the environment, which is black",
                           "`environment` or `sky`"});
        ErrorParts parts = names.no_such_light(wanted, environment ? kEnvironmentWord : "");
        parts.option = "light-groups";
        parts.problem += fmt::format(" for the group '{}'", groups_[g].name);
        throw BadOption(parts);
      }
    }
  }

 private:
  const std::vector<LightGroup>& groups_;
  std::vector<std::vector<bool>> used_;
};

}  // namespace

LightGroups::LightGroups(const std::vector<LightGroup>& groups, const scene::Scene& scene,
                         const Lights& lights) {
  if (groups.empty()) return;
  const Environment& environment = lights.environment();
  const bool own_sun = environment.distant_sun().has_value(), sky = !environment.black() || own_sun;
  const scene::LightNames names(scene);
  Finder finder(groups);
  std::map<std::string, std::size_t> group_of;
  for (const auto* some : {&names.lights, &names.materials}) {
    for (const std::string& name : *some) group_of[name] = finder.group_of(name);
  }
  const std::size_t rest = groups.size();
  const std::size_t of_sky = sky ? finder.group_of(kEnvironmentWord, true) : rest;
  finder.require_all(names, sky);

  bool some_rest = sky && of_sky == rest;
  const auto add = [&](std::vector<std::uint8_t>& to, std::size_t group, bool shines) {
    to.push_back(static_cast<std::uint8_t>(group));
    some_rest = some_rest || (shines && group == rest);
  };
  for (const scene::Instance& instance : scene.instances) {
    const scene::Material& material = scene.material_of(instance);
    add(of_instance_, material.emits() ? group_of.at(material.name) : rest,
        material.emits() || material.unlit);
  }
  for (const scene::PunctualLight& light : lights.placed()) add(of_others_, group_of.at(light.name), true);
  for (std::size_t i = 0; i < lights.distant().size(); ++i) {
    const bool last = i + 1 == lights.distant().size();  // the environment's own sun is the last
    add(of_others_, own_sun && last ? of_sky : group_of.at(lights.distant()[i].name), true);
  }
  add(of_others_, of_sky, false);
  for (const LightGroup& group : groups) names_.push_back(group.name);
  if (some_rest) {
    names_.emplace_back(kRestGroup);
    return;
  }
  // The instances and lights without a group do not emit, so any group will do.
  for (std::vector<std::uint8_t>* some : {&of_instance_, &of_others_})
    std::replace(some->begin(), some->end(), static_cast<std::uint8_t>(rest), std::uint8_t{0});
}

std::vector<std::uint8_t> LightGroups::members() const {
  std::vector<std::uint8_t> all = of_instance_;
  all.insert(all.end(), of_others_.begin(), of_others_.end());
  return all;
}

}  // namespace gatelight::renderer

#include "scene/light_links.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>

#include "base/errors.h"
#include "scene/light_names.h"
#include "scene/object_names.h"
#include "scene/object_sets.h"

namespace gatelight::scene {
namespace {

using Members = std::vector<std::uint8_t>;

class Linker {
 public:
  Linker(Scene& scene, const std::vector<LightLinkRule>& rules)
      : scene_(scene), rules_(rules), used_(rules.size(), false) {
    for (const LightLinkRule& rule : rules) members_.push_back(members_of(rule));
  }

  void link_all() {
    for (PunctualLight& light : scene_.lights) set_link(light.name, light.link);
    for (Instance& instance : scene_.instances) {
      const Material& material = scene_.material_of(instance);
      if (may_emit(scene_, material)) set_link(material.name, instance.link);
    }
    set_link(kEnvironmentWord, scene_.environment_link, true);
    for (std::size_t i = 0; i < used_.size(); ++i) {
      if (!used_[i]) refuse(sentence(LightNames(scene_).no_such_light(rules_[i].light, kEnvironmentWord)));
    }
  }

 private:
  Members members_of(const LightLinkRule& rule) const {
    Members members(scene_.instances.size(), 0);
    for (const std::string& node : rule.nodes) {
      bool found = false;
      for (std::size_t i = 0; i < members.size(); ++i) {
        if (!fits_light_name(node, scene_.instances[i].name)) continue;
        found = true;
        members[i] = 1;
      }
      if (!found) refuse(sentence(ObjectNames(scene_).no_such_object(node, false)));
    }
    return members;
  }

  void set_link(const std::string& name, LightLink& link, bool environment = false) {
    for (const bool blockers : {false, true}) {
      std::vector<std::size_t> fitting;
      for (std::size_t i = 0; i < rules_.size(); ++i) {
        const LightLinkRule& rule = rules_[i];
        const bool fits = (rule.light == kEnvironmentWord) == environment &&
                          (environment || fits_light_name(rule.light, name));
        if (fits && rule.blockers == blockers) fitting.push_back(i);
      }
      if (fitting.empty()) continue;
      for (const std::size_t i : fitting) used_[i] = true;
      const auto [number, is_new] = numbers_.try_emplace(fitting, -1);
      if (is_new) number->second = number_of_set(scene_, set_of(fitting, name));
      (blockers ? link.blockers : link.receivers) = number->second;
    }
  }

  ObjectSet set_of(const std::vector<std::size_t>& rules, const std::string& light) const {
    ObjectSet set{Members(scene_.instances.size(), 1), true};
    const auto each_of = [&](bool exclude, const auto& use) {
      for (const std::size_t r : rules) {
        if (rules_[r].exclude != exclude) continue;
        for (std::size_t i = 0; i < set.instances.size(); ++i) {
          if (members_[r][i] != 0) use(set.instances[i]);
        }
      }
    };
    if (std::any_of(rules.begin(), rules.end(), [&](std::size_t r) { return !rules_[r].exclude; }))
      set = {Members(scene_.instances.size(), 0), false};
    each_of(false, [](std::uint8_t& member) { member = 1; });
    each_of(true, [](std::uint8_t& member) { member = 0; });
    const bool empty = std::find(set.instances.begin(), set.instances.end(), 1) == set.instances.end();
    if (empty && !rules_[rules[0]].blockers)
      refuse(fmt::format("'{}' lights no object, expected at least one receiver", light));
    return set;
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: light-links: {}", scene_.path, what));
  }

  Scene& scene_;
  const std::vector<LightLinkRule>& rules_;
  std::vector<Members> members_;  ///< by the rule
  std::vector<bool> used_;
  std::map<std::vector<std::size_t>, int> numbers_;  ///< of the sets by their rules
};

}  // namespace

void link_lights(Scene& scene, const std::vector<LightLinkRule>& rules) {
  if (!rules.empty()) Linker(scene, rules).link_all();
  tidy_object_sets(scene);
}

}  // namespace gatelight::scene

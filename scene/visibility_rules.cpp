#include "scene/visibility_rules.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "scene/light_names.h"
#include "scene/object_names.h"

namespace gatelight::scene {
namespace {

RayKinds changed(RayKinds rays, const VisibilityRule& rule) {
  if (rule.only) rays = *rule.only;
  return static_cast<RayKinds>((rays | rule.on) & ~rule.off);
}

/// Camera and shadow rays do not meet lamps; other rays would find their light.
bool concerns_lamps(const VisibilityRule& rule) {
  return ((rule.on | rule.off | rule.only.value_or(RayKinds{0})) & kBounceRays) != 0;
}

bool fits(const VisibilityRule& rule, const std::string& name) {
  return rule.name != kEnvironmentWord && fits_light_name(rule.name, name);
}

class Changer {
 public:
  Changer(Scene& scene, const std::vector<VisibilityRule>& rules)
      : scene_(scene), rules_(rules), used_(rules.size(), false) {}

  void change_all() {
    for (Instance& instance : scene_.instances) {
      const auto fits_it = [&](const VisibilityRule& rule) { return fits(rule, instance.name); };
      if (change(instance.visibility.rays, kAllRays, instance.moves, fits_it))
        complain("no ray sees '{}' any more, expected at least one kind of ray", instance.name);
      for (const VisibilityRule& rule : rules_) {
        if (rule.holdout && fits_it(rule)) instance.visibility.holdout = *rule.holdout;
      }
    }
    for (PunctualLight& light : scene_.lights) {
      const auto fits_it = [&](const VisibilityRule& rule) {
        return concerns_lamps(rule) && fits(rule, light.name);
      };
      if (change(light.rays, kBounceRays, scene_.motion.lights, fits_it))
        complain("the light '{}' lights nothing any more, expected diffuse, glossy, transmission or volume",
                 light.name);
    }
    const auto fits_environment = [](const VisibilityRule& rule) { return rule.name == kEnvironmentWord; };
    if (change(scene_.environment_rays, kCameraRays | kBounceRays, false, fits_environment))
      complain("no ray sees the {} any more, expected camera, diffuse, glossy, transmission or volume",
               kEnvironmentWord);
  }

  void check() const {
    for (std::size_t i = 0; i < used_.size(); ++i) {
      if (!used_[i]) refuse(what_is(rules_[i].name));
    }
    if (!problem_.empty()) refuse(problem_);
  }

 private:
  /// Returns whether those rules that fit took the last of `needed`. What changes over time may be without
  /// them for a while.
  template <typename Fits>
  bool change(RayKinds& rays, RayKinds needed, bool changes, const Fits& fits_it) {
    RayKinds of_rules = kAllRays;
    const RayKinds before = rays;
    for (std::size_t i = 0; i < rules_.size(); ++i) {
      if (!fits_it(rules_[i])) continue;
      used_[i] = true;
      of_rules = changed(of_rules, rules_[i]);
      rays = changed(rays, rules_[i]);
    }
    if ((of_rules & needed) == 0) return true;
    return !changes && (before & needed) != 0 && (rays & needed) == 0;
  }

  template <typename Name>
  void complain(fmt::format_string<const Name&> text, const Name& name) {
    if (problem_.empty()) problem_ = fmt::format(text, name);
  }

  /// The reason why a rule of this name changes nothing.
  std::string what_is(const std::string& name) const {
    for (const PunctualLight& light : scene_.lights) {
      if (fits_light_name(name, light.name))
        return fmt::format("'{}' is a light, expected diffuse, glossy, transmission or volume", light.name);
    }
    return sentence(ObjectNames(scene_).no_such_object(name, true));
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: visibility: {}", scene_.path, what));
  }

  Scene& scene_;
  const std::vector<VisibilityRule>& rules_;
  std::vector<bool> used_;
  std::string problem_;
};

}  // namespace

void apply_visibility(Scene& scene, const std::vector<VisibilityRule>& rules) {
  if (rules.empty()) return;
  Changer changer(scene, rules);
  changer.change_all();
  changer.check();
}

void apply_visibility_again(Scene& scene, const std::vector<VisibilityRule>& rules) {
  if (!rules.empty()) Changer(scene, rules).change_all();
}

}  // namespace gatelight::scene

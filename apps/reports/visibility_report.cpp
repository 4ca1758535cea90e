#include "apps/reports/visibility_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <cstdint>
#include <set>
#include <tuple>
#include <utility>

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using scene::LightLink;
using scene::RayKinds;
using scene::Visibility;

constexpr std::size_t kMaxLines = 20;
constexpr std::size_t kMaxNames = 8;

enum class Kind : std::uint8_t { object, light, material, environment };

struct Thing {
  Kind kind;
  std::string name;  ///< empty for the environment

  const char* kind_name() const {
    constexpr const char* kNames[] = {"object", "light", "material", "environment"};
    return kNames[static_cast<std::size_t>(kind)];
  }

  /// As in "'wall'", "light 'key'", "environment".
  std::string text() const {
    if (kind == Kind::environment) return kind_name();
    return kind == Kind::object ? fmt::format("'{}'", name) : fmt::format("{} '{}'", kind_name(), name);
  }

  ordered_json json() const {
    ordered_json json = {{"kind", kind_name()}};
    if (kind != Kind::environment) json["name"] = name;
    return json;
  }
};

/// Calls use(thing, visibility) for what some rays do not see, once for equal names. Of lamps and the
/// environment only `needed` matters.
template <typename Use>
void for_each_visibility(const scene::Scene& scene, const Use& use) {
  std::set<std::tuple<std::string, RayKinds, bool, bool>> seen;
  for (const scene::Instance& instance : scene.instances) {
    const Visibility& v = instance.visibility;
    if (v == Visibility() || !seen.emplace(instance.name, v.rays, v.holdout, v.shadow_catcher).second)
      continue;
    use(Thing{Kind::object, instance.name}, v, scene::kAllRays);
  }
  for (const scene::PunctualLight& light : scene.lights) {
    if ((light.rays & scene::kBounceRays) != scene::kBounceRays)
      use(Thing{Kind::light, light.name}, Visibility{light.rays}, scene::kBounceRays);
  }
  constexpr RayKinds kOfEnvironment = scene::kCameraRays | scene::kBounceRays;
  if ((scene.environment_rays & kOfEnvironment) != kOfEnvironment)
    use(Thing{Kind::environment, ""}, Visibility{scene.environment_rays}, kOfEnvironment);
}

std::vector<std::string> names_of(RayKinds rays) {
  std::vector<std::string> names;
  for (const auto& [name, kind] : scene::kRayKindNames) {
    if (rays & kind) names.emplace_back(name);
  }
  return names;
}

std::string describe(const Visibility& visibility, RayKinds needed) {
  const auto on = static_cast<RayKinds>(visibility.rays & needed);
  const auto off = static_cast<RayKinds>(~visibility.rays & needed);
  std::vector<std::string> parts;
  if (on == 0) {
    parts.emplace_back("without all rays");
  } else if (std::popcount(on) < std::popcount(off)) {
    parts.push_back(fmt::format("only {}", fmt::join(names_of(on), ", ")));
  } else if (off != 0) {
    parts.push_back(fmt::format("without {}", fmt::join(names_of(off), ", ")));
  }
  if (visibility.holdout) parts.emplace_back("holdout");
  if (visibility.shadow_catcher) parts.emplace_back("shadow catcher");
  return fmt::format("{}", fmt::join(parts, "; "));
}

/// Calls use(thing, link) for lights that do not concern all objects, once for equal names and links.
template <typename Use>
void for_each_link(const scene::Scene& scene, const Use& use) {
  std::set<std::tuple<std::string, int, int>> seen;
  for (const scene::PunctualLight& light : scene.lights) {
    if (light.link.any()) use(Thing{Kind::light, light.name}, light.link);
  }
  for (const scene::Instance& instance : scene.instances) {
    const LightLink& link = instance.link;
    const std::string& name = scene.material_of(instance).name;
    if (link.any() && seen.emplace(name, link.receivers, link.blockers).second)
      use(Thing{Kind::material, name}, link);
  }
  if (scene.environment_link.any()) use(Thing{Kind::environment, ""}, scene.environment_link);
}

/// The names of a set's members, or, where it has fog, of all others.
std::set<std::string> names_of(const scene::Scene& scene, const scene::ObjectSet& set) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if ((set.instances[i] != 0) != set.fog) names.insert(scene.instances[i].name);
  }
  return names;
}

const scene::ObjectSet& set_of(const scene::Scene& scene, int number) {
  return scene.object_sets[static_cast<std::size_t>(number)];
}

std::string describe_set(const scene::Scene& scene, int number) {
  const scene::ObjectSet& set = set_of(scene, number);
  const std::set<std::string> names = names_of(scene, set);
  std::vector<std::string> quoted;
  for (const std::string& name : names) {
    if (quoted.size() < kMaxNames) quoted.push_back(fmt::format("'{}'", name));
  }
  if (names.size() > kMaxNames) quoted.push_back(fmt::format("and {} more", names.size() - kMaxNames));
  if (quoted.empty()) quoted.emplace_back("nothing");
  return fmt::format("{} {}", set.fog ? "all but" : "only", fmt::join(quoted, ", "));
}

ordered_json set_json(const scene::Scene& scene, int number) {
  const scene::ObjectSet& set = set_of(scene, number);
  return {{set.fog ? "all_but" : "only", names_of(scene, set)}};
}

void add_line(std::vector<std::string>& lines, std::string line) {
  if (lines.size() < kMaxLines) {
    lines.push_back(std::move(line));
  } else if (lines.size() == kMaxLines) {
    lines.emplace_back("...");
  }
}

}  // namespace

std::vector<std::string> describe_visibility(const scene::Scene& scene) {
  std::vector<std::string> lines;
  for_each_visibility(scene, [&](const Thing& thing, const Visibility& visibility, RayKinds needed) {
    add_line(lines, fmt::format("{} {}", thing.text(), describe(visibility, needed)));
  });
  return lines;
}

ordered_json visibility_json(const scene::Scene& scene) {
  ordered_json list = ordered_json::array();
  for_each_visibility(scene, [&](const Thing& thing, const Visibility& visibility, RayKinds needed) {
    ordered_json json = thing.json();
    json["rays"] = names_of(static_cast<RayKinds>(visibility.rays & needed));
    if (visibility.holdout) json["holdout"] = true;
    if (visibility.shadow_catcher) json["shadow_catcher"] = true;
    list.push_back(std::move(json));
  });
  return list;
}

std::vector<std::string> describe_light_links(const scene::Scene& scene) {
  std::vector<std::string> lines;
  for_each_link(scene, [&](const Thing& thing, const LightLink& link) {
    std::vector<std::string> parts;
    if (link.receivers >= 0) parts.push_back("lights " + describe_set(scene, link.receivers));
    if (link.blockers >= 0) parts.push_back("is blocked by " + describe_set(scene, link.blockers));
    add_line(lines, fmt::format("{} {}", thing.text(), fmt::join(parts, "; ")));
  });
  return lines;
}

ordered_json light_links_json(const scene::Scene& scene) {
  ordered_json list = ordered_json::array();
  for_each_link(scene, [&](const Thing& thing, const LightLink& link) {
    ordered_json json = thing.json();
    if (link.receivers >= 0) json["receivers"] = set_json(scene, link.receivers);
    if (link.blockers >= 0) json["blockers"] = set_json(scene, link.blockers);
    list.push_back(std::move(json));
  });
  return list;
}

}  // namespace gatelight::apps

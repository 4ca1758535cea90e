#include "apps/settings/visibility_flags.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/settings/parsing.h"
#include "base/errors.h"

namespace gatelight::apps {
namespace {

using scene::LightLinkRule;
using scene::RayKinds;
using scene::VisibilityRule;

constexpr const char* kHoldout = "holdout";
constexpr scene::RayKindName kSeveral[] = {{"reflections", scene::kDiffuseRays | scene::kGlossyRays},
                                           {"bounces", scene::kBounceRays}};

/// 0 for other words.
RayKinds rays_named(const std::string& word) {
  for (const auto& [name, kinds] : scene::kRayKindNames) {
    if (name == word) return kinds;
  }
  for (const auto& [name, kinds] : kSeveral) {
    if (name == word) return kinds;
  }
  return 0;
}

std::string all_ray_names() {
  std::string names;
  for (const auto& [name, kinds] : scene::kRayKindNames) names += fmt::format("{}|", name);
  for (const auto& [name, kinds] : kSeveral) names += fmt::format("{}|", name);
  return names + kHoldout;
}

void read_rays(const std::string& option, const std::string& part, VisibilityRule& rule) {
  const std::size_t colon = part.find(':');
  if (colon == std::string::npos) throw BadOption({option, part, "", "RAYS:on|off|only"});
  const std::string word = trimmed(part.substr(0, colon)), state = trimmed(part.substr(colon + 1));
  const RayKinds rays = rays_named(word);
  const bool is_holdout = word == kHoldout;
  if (rays == 0 && !is_holdout) refuse_choice(option, word, all_ray_names());
  if (is_holdout && state != "on" && state != "off") refuse_choice(option, state, "on|off");
  const auto without = [](RayKinds from, RayKinds what) { return static_cast<RayKinds>(from & ~what); };
  if (is_holdout) {
    rule.holdout = state == "on";
  } else if (state == "on") {
    rule.on |= rays;
    rule.off = without(rule.off, rays);
  } else if (state == "off") {
    rule.off |= rays;
    rule.on = without(rule.on, rays);
  } else if (state == "only") {
    rule.only = static_cast<RayKinds>(rule.only.value_or(RayKinds{0}) | rays);
  } else {
    refuse_choice(option, state, "on|off|only");
  }
}

VisibilityRule read_rule(const std::string& option, const std::string& text) {
  // Names may contain '='; values do not.
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw BadOption({option, text, "", "NAME=RAYS:on|off|only,..."});
  VisibilityRule rule{.name = text.substr(0, equals)};
  for (const std::string& part : split(text.substr(equals + 1), ',')) read_rays(option, part, rule);
  if (rule.holdout && rule.name == scene::kEnvironmentWord)
    throw BadOption({option, text, "makes a holdout of the environment", "an object"});
  return rule;
}

struct LinkKey {
  const char* name;
  bool blockers;
  bool exclude;
};
constexpr LinkKey kLinkKeys[] = {{"receivers", false, false},
                                 {"not-receivers", false, true},
                                 {"blockers", true, false},
                                 {"not-blockers", true, true}};
constexpr const char* kLinkForm = "LIGHT=receivers:NODE+NODE,blockers:NODE";

/// The key before the first ':'; null for other words.
const LinkKey* find_key(const std::string& text) {
  const std::string word = trimmed(text.substr(0, text.find(':')));
  for (const LinkKey& key : kLinkKeys) {
    if (key.name == word) return &key;
  }
  return nullptr;
}

/// The '=' after the name of the light. Names, also those of nodes, may contain '='.
std::size_t find_equals(const std::string& text) {
  const std::size_t first = text.find('=');
  for (std::size_t at = first; at != std::string::npos; at = text.find('=', at + 1)) {
    if (find_key(text.substr(at + 1))) return at;
  }
  return first;
}

void read_link(const std::string& option, const std::string& text, std::vector<LightLinkRule>& rules) {
  const std::size_t equals = find_equals(text);
  if (equals == std::string::npos || equals == 0) throw BadOption({option, text, "", kLinkForm});
  for (const std::string& part : split(text.substr(equals + 1), ',')) {
    const std::size_t colon = part.find(':');
    if (colon == std::string::npos) throw BadOption({option, text, "", kLinkForm});
    const LinkKey* const key = find_key(part);
    if (!key)
      refuse_choice(option, trimmed(part.substr(0, colon)), "receivers|not-receivers|blockers|not-blockers");
    LightLinkRule rule{text.substr(0, equals), key->blockers, key->exclude,
                       split(part.substr(colon + 1), '+')};
    for (const std::string& node : rule.nodes) {
      if (node.empty()) throw BadOption({option, part, "lacks a name", "NODE+NODE"});
    }
    rules.push_back(std::move(rule));
  }
}

}  // namespace

std::vector<VisibilityRule> read_visibility(const std::string& option, const std::string& text) {
  std::vector<VisibilityRule> rules;
  for (const std::string& part : split(text, ';')) rules.push_back(read_rule(option, part));
  return rules;
}

std::string text_of(const std::vector<VisibilityRule>& rules) {
  std::string text;
  for (const VisibilityRule& rule : rules) {
    std::vector<std::string> parts;
    const auto add = [&](RayKinds rays, const char* state) {
      for (const auto& [name, kind] : scene::kRayKindNames) {
        if (rays & kind) parts.push_back(fmt::format("{}:{}", name, state));
      }
    };
    if (rule.only) add(*rule.only, "only");
    add(rule.on, "on");
    add(rule.off, "off");
    if (rule.holdout) parts.push_back(fmt::format("{}:{}", kHoldout, *rule.holdout ? "on" : "off"));
    text += fmt::format("{}{}={}", text.empty() ? "" : ";", rule.name, fmt::join(parts, ","));
  }
  return text;
}

std::vector<LightLinkRule> read_light_links(const std::string& option, const std::string& text) {
  std::vector<LightLinkRule> rules;
  for (const std::string& part : split(text, ';')) read_link(option, part, rules);
  return rules;
}

std::string text_of(const std::vector<LightLinkRule>& rules) {
  std::string text;
  const std::string* light = nullptr;
  for (const LightLinkRule& rule : rules) {
    for (const LinkKey& key : kLinkKeys) {
      if (key.blockers != rule.blockers || key.exclude != rule.exclude) continue;
      if (light && *light == rule.light) {
        text += ",";
      } else {
        text += fmt::format("{}{}=", text.empty() ? "" : ";", rule.light);
      }
      text += fmt::format("{}:{}", key.name, fmt::join(rule.nodes, "+"));
    }
    light = &rule.light;
  }
  return text;
}

}  // namespace gatelight::apps

#include "renderer/fingerprint/named_texts.h"

#include <fmt/format.h>

#include <algorithm>

namespace gatelight::renderer {

void add_texts(Metadata& metadata, const std::string& prefix, const NamedTexts& texts) {
  for (const NamedText& t : texts) metadata[fmt::format("{}.{}", prefix, t.name)] = t.text;
}

std::string list_differences(const Metadata& metadata, const std::string& prefix,
                             const NamedTexts& expected) {
  std::string differences;
  const auto add = [&](const std::string& name, const std::string& file, const std::string& here) {
    differences +=
        fmt::format("{}{}: file {}, expected {}", differences.empty() ? "" : "; ", name, file, here);
  };
  for (const NamedText& t : expected) {
    const auto found = metadata.find(fmt::format("{}.{}", prefix, t.name));
    if (found == metadata.end()) {
      add(t.name, "nothing", t.text);
    } else if (found->second != t.text) {
      add(t.name, found->second, t.text);
    }
  }
  const std::string beginning = prefix + ".";
  for (const auto& [key, text] : metadata) {
    if (!key.starts_with(beginning)) continue;
    const std::string name = key.substr(beginning.size());
    const bool known =
        std::any_of(expected.begin(), expected.end(), [&](const NamedText& t) { return t.name == name; });
    if (!known) add(name, text, "nothing");
  }
  return differences;
}

void expect_scene(const SafetensorsReader& file, const NamedTexts& scene,
                  const std::vector<std::string>& ignored) {
  std::string parts;
  for (const NamedText& part : scene) {
    const auto found = file.metadata().find(fmt::format("{}.{}", kScene, part.name));
    const bool same = found != file.metadata().end() && found->second == part.text;
    if (same || std::find(ignored.begin(), ignored.end(), part.name) != ignored.end()) continue;
    parts += fmt::format("{}{}", parts.empty() ? "" : ", ", part.name);
  }
  if (!parts.empty()) file.fail(fmt::format("it belongs to another scene: it differs in {}", parts));
}

}  // namespace gatelight::renderer

#include "renderer/settings/aovs.h"

#include <cctype>

namespace gatelight::renderer {

std::vector<std::string> channels_of(const AovInfo& aov) {
  const std::string_view c = aov.channels;
  if (std::any_of(c.begin(), c.end(), [](unsigned char letter) { return std::islower(letter) != 0; }))
    return {std::string(c)};
  std::vector<std::string> channels;
  for (const char letter : c) channels.emplace_back(1, letter);
  return channels;
}

std::vector<Aov> passes_among(std::span<const Aov> aovs) {
  std::vector<Aov> passes;
  for (const Aov aov : aovs) {
    if (info_of(aov).source == AovSource::pass) passes.push_back(aov);
  }
  return passes;
}

std::vector<Aov> all_passes() {
  std::vector<Aov> all;
  for (const AovInfo& row : kAovs) all.push_back(row.aov);
  return passes_among(all);
}

}  // namespace gatelight::renderer

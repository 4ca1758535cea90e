#pragma once
// Facts of a run as named texts: stored in the metadata of files, and compared with those of another run.

#include <string>
#include <vector>

#include "base/file/safetensors.h"

namespace gatelight::renderer {

struct NamedText {
  std::string name;
  std::string text;
  friend bool operator==(const NamedText&, const NamedText&) = default;
};
using NamedTexts = std::vector<NamedText>;

/// Stores the texts under "PREFIX.NAME".
void add_texts(Metadata& metadata, const std::string& prefix, const NamedTexts& texts);

/// The differences between the metadata under the prefix and `expected`: "seed: file 1, expected 2; filter:
/// file nothing, expected box". Empty: there are none.
std::string list_differences(const Metadata& metadata, const std::string& prefix, const NamedTexts& expected);

/// The prefix of a scene's fingerprint.
inline constexpr const char* kScene = "scene";
/// Throws CacheFileError naming the parts in which the scene of the file differs. Parts named in
/// `ignored` may differ.
void expect_scene(const SafetensorsReader& file, const NamedTexts& scene,
                  const std::vector<std::string>& ignored = {});

}  // namespace gatelight::renderer

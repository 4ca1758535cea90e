#pragma once
// Small renders of one square through the real program.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/support/folder_test.h"
#include "tests/support/process.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {

class SquareRenders : public FolderTest {
 protected:
  Output render(const Words& flags) const {
    if (std::find(flags.begin(), flags.end(), "--spp") != flags.end()) return render_open(flags);
    return render_open(words_of("--spp 4", {}, flags));
  }

  /// Renders without --spp.
  Output render_open(const Words& flags) const {
    return run_gatelight(words_of("render {} --environment 1,1,1 --size 24x16", {scene}, flags));
  }

  std::string scene = folder.write("scene.gltf", tiny_scene());
};

inline std::set<std::string> keys(const nlohmann::json& object) {
  std::set<std::string> names;
  for (const auto& [key, value] : object.items()) names.insert(key);
  return names;
}

}  // namespace gatelight::tests

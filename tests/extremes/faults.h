#pragma once
// Renders through the real program while a resource of the system fails.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/folder_test.h"
#include "tests/support/process.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {

class Faults : public FolderTest {
 protected:
  /// A square under a white sky.
  std::vector<std::string> words(const std::vector<std::string>& more) const {
    std::vector<std::string> all = {"render", scene, "--environment", "1,1,1", "--threads", "2"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  std::string scene = folder.write("scene.gltf", tiny_scene());
};

}  // namespace gatelight::tests

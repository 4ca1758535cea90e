#pragma once
// Renders through the real program while a resource of the system fails.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/folder_test.h"
#include "tests/support/process.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {

class Faults : public FolderTest {
 protected:
  /// A render of a square under a white sky.
  Words square(const std::string& line, const Words& values = {}, const Words& more = {}) const {
    return words_of("render {} --environment 1,1,1 --threads 2", {scene}, words_of(line, values, more));
  }

  std::string scene = folder.write("scene.gltf", tiny_scene());
};

}  // namespace gatelight::tests

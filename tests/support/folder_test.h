#pragma once
// A test with a temporary folder.

#include <gtest/gtest.h>

#include <string>

#include "tests/support/temporary_folder.h"

namespace gatelight::tests {

class FolderTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder / name).string(); }

  TemporaryFolder folder;
};

}  // namespace gatelight::tests

#include <gtest/gtest.h>

#include "renderer/image/image_write.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {

using tests::FileSizeLimit;
using tests::read_file;
using tests::TemporaryFolder;

/// A picture that does not compress.
Picture noise(int size) {
  Picture picture{.width = size, .height = size};
  Layer beauty{.channels = {"R", "G", "B"}};
  std::uint32_t state = 1;
  for (int i = 0; i < 3 * size * size; ++i) {
    state = state * 1664525u + 1013904223u;
    beauty.values.push_back(static_cast<float>(state >> 8) / 16777216.0f);
  }
  picture.layers = {beauty};
  return picture;
}

TEST(WriteImage, AFullDiskLeavesTheOldPictureWholeAndNoHalfFile) {
  for (const char* name : {"a.exr", "a.png"}) {
    const TemporaryFolder folder;
    folder.write(name, "the old picture");
    const std::string message = [&] {
      const FileSizeLimit limit(8192);
      return tests::refusal<OutputError>([&] { write_image(noise(256), folder / name); });
    }();
    tests::expect_message(message, {(folder / name).string()});
    EXPECT_EQ(read_file(folder / name), "the old picture");
    EXPECT_EQ(folder.count_files(), 1u);
  }
}

}  // namespace
}  // namespace gatelight::renderer

// Sizes that the header of a picture claims, compared with the bytes of the file.

#include "base/image/claimed_size.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace gatelight {
namespace {

using tests::expect_message;

class ClaimedSize : public ::testing::Test {
 protected:
  /// Returns the message about such a picture in a file of this many bytes, or nothing if it is accepted.
  std::string said(std::int64_t width, std::int64_t height, std::int64_t channels, std::uintmax_t bytes) {
    std::ofstream(file_).put('x');
    std::filesystem::resize_file(file_, bytes);
    return tests::refusal<std::runtime_error>([&] { check_claimed_size(width, height, channels, file_); });
  }

  tests::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "picture";
};

TEST_F(ClaimedSize, SmallPicturesNeedNoBytes) {
  EXPECT_EQ(said(1, 1, 1, 1), "");
  EXPECT_EQ(said(2048, 2048, 4, 1), "");
}

TEST_F(ClaimedSize, LargePicturesNeedEnoughBytes) {
  EXPECT_EQ(said(8192, 8192, 4, 16385), "");
  expect_message(said(8192, 8192, 4, 16000), {"8192", "4", "16000"});
}

TEST_F(ClaimedSize, ProductsDoNotOverflow) {
  constexpr std::int64_t kHuge = std::numeric_limits<std::int64_t>::max();
  const std::string huge = std::to_string(kHuge);
  expect_message(said(kHuge, 2, 3, 100), {huge, "2", "3"});
  expect_message(said(2, kHuge, 3, 100), {huge, "2", "3"});
  expect_message(said(2, 2, kHuge, 100), {huge, "2"});
  expect_message(said(1 << 20, 1 << 20, 1 << 20, 100), {"1048576"});
}

TEST_F(ClaimedSize, ASideHasAtMost65536Pixels) {
  EXPECT_EQ(said(1 << 16, 2, 4, 100), "");
  expect_message(said((1 << 16) + 1, 2, 4, 100), {"65537", "2", "4"});
  expect_message(said(2, (1 << 16) + 1, 4, 100), {"2", "65537", "4"});
}

TEST_F(ClaimedSize, APictureWithoutPixelsIsRefused) {
  expect_message(said(0, 1, 1, 1), {"pixels"});
  expect_message(said(1, -1, 1, 1), {"pixels"});
  expect_message(said(1, 1, 0, 1), {"pixels"});
}

TEST_F(ClaimedSize, AMissingFileIsRefused) {
  EXPECT_THROW(check_claimed_size(8192, 8192, 4, folder_ / "none"), std::runtime_error);
}

}  // namespace
}  // namespace gatelight

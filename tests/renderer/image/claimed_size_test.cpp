// Sizes that the header of a picture claims, against the bytes that are there.

#include "renderer/image/claimed_size.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {

using ::testing::HasSubstr;

class ClaimedSize : public ::testing::Test {
 protected:
  /// What is said of such a picture in a file of so many bytes; empty: nothing.
  std::string said(std::int64_t width, std::int64_t height, std::int64_t channels, std::uintmax_t bytes) {
    std::ofstream(file_).put('x');
    std::filesystem::resize_file(file_, bytes);
    try {
      check_claimed_size(width, height, channels, file_);
      return "";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  }

  tests::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "picture";
};

TEST_F(ClaimedSize, SmallPicturesMayClaimWhatTheyLike) {
  EXPECT_EQ(said(1, 1, 1, 1), "");
  EXPECT_EQ(said(2048, 2048, 4, 1), "");
}

TEST_F(ClaimedSize, LargeOnesNeedBytesThatCouldHoldThem) {
  EXPECT_EQ(said(8192, 8192, 4, 16385), "");
  EXPECT_THAT(said(8192, 8192, 4, 16000),
              HasSubstr("8192 x 8192 pixels of 4 channels are too many for a file of 16000"));
}

TEST_F(ClaimedSize, NothingIsMultipliedBeyondItsRange) {
  constexpr std::int64_t kHuge = std::numeric_limits<std::int64_t>::max();
  EXPECT_THAT(said(kHuge, 2, 3, 100), HasSubstr("are too many"));
  EXPECT_THAT(said(2, kHuge, 3, 100), HasSubstr("are too many"));
  EXPECT_THAT(said(2, 2, kHuge, 100), HasSubstr("are too many"));
  EXPECT_THAT(said(1 << 20, 1 << 20, 1 << 20, 100), HasSubstr("are too many"));
}

TEST_F(ClaimedSize, ASideIsNoLongerThanThatOfOurPictures) {
  EXPECT_EQ(said(1 << 16, 2, 4, 100), "");
  EXPECT_THAT(said((1 << 16) + 1, 2, 4, 100), HasSubstr("65537 x 2 pixels of 4 channels are too many"));
  EXPECT_THAT(said(2, (1 << 16) + 1, 4, 100), HasSubstr("are too many"));
}

TEST_F(ClaimedSize, ThereIsAPixel) {
  EXPECT_EQ(said(0, 1, 1, 1), "it has no pixels");
  EXPECT_EQ(said(1, -1, 1, 1), "it has no pixels");
  EXPECT_EQ(said(1, 1, 0, 1), "it has no pixels");
}

TEST_F(ClaimedSize, AFileThatIsGoneHoldsNothing) {
  EXPECT_THROW(check_claimed_size(8192, 8192, 4, folder_ / "none"), std::runtime_error);
}

}  // namespace
}  // namespace gatelight::renderer

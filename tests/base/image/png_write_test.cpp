#include "base/image/png_write.h"

#include <gtest/gtest.h>

#include <numeric>

#include "base/image/png_read.h"

namespace gatelight {
namespace {

TEST(PngWrite, EightBitsComeBackWithAndWithoutAlpha) {
  for (const int channels : {3, 4}) {
    std::vector<std::uint8_t> pixels(5 * 3 * static_cast<std::size_t>(channels));
    std::iota(pixels.begin(), pixels.end(), std::uint8_t{0});
    PngReader reader(encode_png(std::span<const std::uint8_t>(pixels), 5, 3, channels));
    EXPECT_EQ(reader.width(), 5);
    EXPECT_EQ(reader.height(), 3);
    EXPECT_EQ(reader.channels(), channels);
    EXPECT_EQ(reader.bits(), 8);
    EXPECT_EQ(reader.read_8(), pixels);
  }
}

TEST(PngWrite, AllSixteenBitsComeBack) {
  std::vector<std::uint16_t> pixels(std::size_t{7} * 2 * 3);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint16_t>(1571 * i + 3);
  PngReader reader(encode_png(std::span<const std::uint16_t>(pixels), 7, 2, 3));
  EXPECT_EQ(reader.bits(), 16);
  EXPECT_EQ(reader.read_16(), pixels);
}

TEST(PngWrite, APictureWithoutPixelsIsRefused) {
  EXPECT_THROW(encode_png(std::span<const std::uint8_t>(), 0, 0, 3), std::runtime_error);
}

}  // namespace
}  // namespace gatelight

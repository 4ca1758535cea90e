// The order of single samples: every pixel in turn, and any part of it evenly over the picture.

#include "renderer/film/sample_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace gatelight::renderer {
namespace {

TEST(SampleOrder, EveryPixelOfARegionHasItsNextSampleInEachRound) {
  for (const PixelRect region :
       {PixelRect{0, 0, 1, 1}, PixelRect{5, 7, 6, 40}, PixelRect{3, 2, 30, 19}, PixelRect{0, 0, 64, 36}}) {
    const SampleOrder order(region);
    const auto pixels =
        static_cast<std::uint64_t>(region.width()) * static_cast<std::uint64_t>(region.height());
    for (std::uint32_t round = 0; round < 3; ++round) {
      std::vector<int> visits(pixels, 0);
      for (std::uint64_t i = 0; i < pixels; ++i) {
        const auto [pixel, number] = order.at(round * pixels + i);
        ASSERT_EQ(number, round);
        ASSERT_TRUE(pixel.x >= region.x0 && pixel.x < region.x1 && pixel.y >= region.y0 &&
                    pixel.y < region.y1);
        ++visits[static_cast<std::size_t>((pixel.y - region.y0) * region.width() + pixel.x - region.x0)];
      }
      EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), static_cast<std::ptrdiff_t>(pixels));
    }
  }
}

TEST(SampleOrder, AnyPartCoversThePictureEvenly) {
  for (const auto& [width, height] :
       {std::pair{960, 540}, {640, 360}, {480, 270}, {1920, 1080}, {512, 512}}) {
    const SampleOrder order({0, 0, width, height});
    constexpr std::uint64_t kPart = 4800;
    for (const std::uint64_t first : {0ull, 1234ull, 100000ull}) {
      // Of 12 x 8 areas each should have 50.
      std::array<int, 96> areas{};
      for (std::uint64_t i = 0; i < kPart; ++i) {
        const Pixel pixel = order.at(first + i).pixel;
        ++areas[static_cast<std::size_t>(pixel.y * 8 / height * 12 + pixel.x * 12 / width)];
      }
      double squares = 0.0;
      for (const int count : areas) squares += (count - 50.0) * (count - 50.0);
      EXPECT_LT(squares / 96.0, 20.0) << width << "x" << height << ": independent points have 50";
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer

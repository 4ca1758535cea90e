#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <limits>
#include <map>
#include <vector>

#include "base/random.h"
#include "neural/layout/surface_layout.h"

namespace gatelight::neural {
namespace {

TEST(Weld, GivesTheFirstPositionWithTheSameFloats) {
  const float tiny = std::numeric_limits<float>::denorm_min();
  const std::vector<Float3> positions = {{1, 2, 3}, {0, 0, 0},    {1, 2, 3},     {-0.0f, 0, -0.0f}, {3, 2, 1},
                                         {0, 0, 0}, {0, 0, tiny}, {0, 0, -tiny}, {1, 2, 3.0000002f}};
  EXPECT_EQ(weld_vertices(positions), (std::vector<std::uint32_t>{0, 1, 0, 1, 4, 1, 6, 7, 8}));
  EXPECT_TRUE(weld_vertices({}).empty());
}

TEST(Weld, AgreesWithAMapForAnyNumberOfThreads) {
  std::vector<Float3> positions;
  for (std::uint32_t n = 0; n < 200000; ++n) {
    const auto coordinate = [&](std::uint32_t c) {
      return static_cast<float>(mix_bits(3 * n + c) % 40) * 0.1f;
    };
    positions.push_back({coordinate(0), coordinate(1), coordinate(2)});
  }
  std::map<Float3, std::uint32_t> first;
  std::vector<std::uint32_t> expected;
  for (std::uint32_t n = 0; n < positions.size(); ++n)
    expected.push_back(first.emplace(positions[n], n).first->second);
  for (const std::size_t threads : {1, 2, 7}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    EXPECT_TRUE(weld_vertices(positions) == expected);
  }
}

}  // namespace
}  // namespace gatelight::neural

#include "renderer/distributed/shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace gatelight::renderer {
namespace {

TEST(Shares, FollowTheSpeeds) {
  const double speeds[] = {1.0, 3.0};
  const Shares shares(100, speeds);
  EXPECT_EQ(shares.begin(0), 0);
  EXPECT_EQ(shares.end(0), 25);
  EXPECT_EQ(shares.begin(1), 25);
  EXPECT_EQ(shares.end(1), 100);
  EXPECT_EQ(shares.owner(24), 0);
  EXPECT_EQ(shares.owner(25), 1);
  EXPECT_EQ(shares.owner(99), 1);
}

TEST(Shares, MoreRanksThanTilesLeaveSomeWithout) {
  const double speeds[] = {1.0, 1.0, 1.0, 1.0, 1.0};
  const Shares shares(3, speeds);
  int tiles = 0;
  for (int r = 0; r < 5; ++r) {
    EXPECT_LE(shares.begin(r), shares.end(r));
    for (int t = shares.begin(r); t < shares.end(r); ++t, ++tiles) EXPECT_EQ(shares.owner(t), r);
  }
  EXPECT_EQ(tiles, 3);
}

/// Tiles of very different work, ranks of very different speed.
TEST(Shares, ConvergeToEqualTimes) {
  constexpr int kTiles = 1000, kRanks = 4;
  const double seconds_of_ray[kRanks] = {1.0, 0.3, 2.0, 0.5};
  const auto rays_of = [](int tile) { return tile < 300 ? 2 : tile < 500 ? 30 : 8; };
  const double equal[] = {1.0, 1.0, 1.0, 1.0};
  Shares shares(kTiles, equal);
  std::vector<RankWork> measured(kRanks);
  double imbalance = 0.0;
  for (int pass = 0; pass < 20; ++pass) {
    double sum = 0.0, most = 0.0;
    for (int r = 0; r < kRanks; ++r) {
      RankWork& work = measured[static_cast<std::size_t>(r)];
      work.rays = 0;
      for (int t = shares.begin(r); t < shares.end(r); ++t)
        work.rays += static_cast<std::uint64_t>(rays_of(t));
      work.seconds = static_cast<double>(work.rays) * seconds_of_ray[r];
      sum += work.seconds;
      most = std::max(most, work.seconds);
    }
    imbalance = most * kRanks / sum;
    if (pass == 0) {
      EXPECT_GT(imbalance, 2.0);
    }
    shares.rebalance(measured);
  }
  EXPECT_LT(imbalance, 1.03);
  EXPECT_FALSE(shares.rebalance(measured));
}

TEST(Shares, StayWhereNothingWasMeasured) {
  const double speeds[] = {1.0, 1.0};
  Shares shares(10, speeds);
  EXPECT_FALSE(shares.rebalance(std::vector<RankWork>(2)));
  EXPECT_EQ(shares.end(0), 5);
}

}  // namespace
}  // namespace gatelight::renderer

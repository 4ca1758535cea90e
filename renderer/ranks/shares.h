#pragma once
// How the work of a picture is dealt to its ranks.

#include <cstdint>
#include <span>
#include <vector>

namespace gatelight::renderer {

/// What a rank did and how long it took.
struct RankWork {
  double seconds = 0.0;
  std::uint64_t rays = 0;
};

/// Each rank has a range of the tiles of a picture, in their order. Equal on all ranks.
class Shares {
 public:
  /// As long as the ranks' speeds ask for, for example their numbers of threads.
  Shares(int tiles, std::span<const double> speeds);

  int begin(int rank) const { return begins_[static_cast<std::size_t>(rank)]; }
  int end(int rank) const { return begins_[static_cast<std::size_t>(rank) + 1]; }
  int owner(int tile) const;

  /// Learns from what was measured for these shares how much work the tiles are and how fast the ranks. Deals
  /// anew where some rank would take much longer than the others; else returns false.
  bool rebalance(std::span<const RankWork> measured);

 private:
  void learn(std::span<const RankWork> measured);
  /// The longest time that is expected of a rank over the mean.
  double imbalance() const;
  void deal();

  std::vector<int> begins_;      ///< of each rank; then the number of tiles
  std::vector<double> density_;  ///< expected rays of each tile, up to a factor
  std::vector<double> speeds_;   ///< rays a second of each rank, up to a factor
  bool measured_ = false;        ///< the speeds are no guess
};

}  // namespace gatelight::renderer

#pragma once
// Distributes the work of a picture over its ranks.

#include <cstdint>
#include <span>
#include <vector>

namespace gatelight::renderer {

/// The work of a rank and its time.
struct RankWork {
  double seconds = 0.0;
  std::uint64_t rays = 0;
};

/// Each rank has a range of the tiles of a picture, in their order. Equal on all ranks.
class Shares {
 public:
  /// Ranges in proportion to the ranks' speeds, for example their numbers of threads.
  Shares(int tiles, std::span<const double> speeds);

  int begin(int rank) const { return begins_[static_cast<std::size_t>(rank)]; }
  int end(int rank) const { return begins_[static_cast<std::size_t>(rank) + 1]; }
  int owner(int tile) const;

  /// Updates the work of the tiles and the speeds of the ranks from measurements of these shares. Distributes
  /// the tiles anew where some rank would take much longer than the others; else returns false.
  bool rebalance(std::span<const RankWork> measured);

 private:
  void learn(std::span<const RankWork> measured);
  /// The longest expected time of a rank over the mean.
  double imbalance() const;
  void rebalance();

  std::vector<int> begins_;      ///< of each rank; then the number of tiles
  std::vector<double> density_;  ///< expected rays of each tile, up to a factor
  std::vector<double> speeds_;   ///< rays a second of each rank, up to a factor
  bool measured_ = false;        ///< the speeds come from measurements
};

}  // namespace gatelight::renderer

#pragma once
// The processes that make one picture together, and their shares of its work.

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "renderer/cache/record_exchange.h"
#include "renderer/distributed/shared_file.h"
#include "renderer/driver/prepared_picture.h"
#include "renderer/film/film.h"
#include "renderer/film/tiles.h"

namespace gatelight::renderer {

/// All call the same functions in the same order, and each has some tiles of the film. The first one finishes
/// the pictures and writes their files. A single process has all tiles and finishes.
class PictureTeam {
 public:
  explicit PictureTeam(const PreparedPicture& picture);
  PictureTeam(const PictureTeam&) = delete;
  PictureTeam& operator=(const PictureTeam&) = delete;

  bool is_alone() const { return all_.ranks.is_single(); }
  /// Whether this process finishes.
  bool finishes() const { return all_.ranks.first(); }

  /// The value of the one that finishes, for all.
  template <class T>
  T agreed(T mine) const {
    return all_.ranks.agreed(std::move(mine));
  }
  /// Whether `mine` is true anywhere.
  bool any(bool mine) const { return all_.ranks.any(mine); }
  template <class T>
  std::vector<T> of_each(const T& mine) const {
    return all_.ranks.of_each(mine);
  }
  /// The values of all, one after the other.
  template <class T>
  std::vector<T> joined(std::vector<T> mine) const {
    return all_.ranks.joined(std::move(mine));
  }
  /// A file that only the one that finishes needs to have (share_file()).
  SharedFile shared(const std::filesystem::path& path) const { return share_file(all_.ranks, path); }
  Traffic traffic() const { return all_.ranks.traffic(); }

  /// This process's tiles; rebalance() changes them.
  const TileGrid& own() const { return own_; }
  /// Of the caches that learn the picture.
  RecordExchange records() const { return RecordExchange(all_); }
  /// This process's rows of a picture, as many as its threads can do.
  PixelRect own_rows(const PixelRect& picture) const;
  /// The rows of all for the one that finishes; the others get nothing.
  std::vector<float> joined_rows(std::vector<float> mine) const {
    return all_.ranks.joined_at_first(std::move(mine));
  }

  /// The one that finishes gets the whole film.
  void gather(Film& film) const;
  /// Distributes the tiles anew where some process took much longer than others.
  void rebalance(Film& film, const std::vector<RankWork>& measured);

  /// Number of samples in this process's tiles.
  std::uint64_t own_samples(const Film& film) const;
  /// Mean over all pixels, of all processes.
  double samples_per_pixel(const Film& film) const;

 private:
  /// Sends each process the sums of the tiles that it wants and another one has by `shares`. `wants` is the
  /// same on all.
  void exchange(Film& film, const Shares& shares, const std::function<bool(int rank, int tile)>& wants) const;

  std::vector<double> threads_;  ///< of each process
  SharedTiles all_;              ///< of the whole film
  TileGrid own_;
};

}  // namespace gatelight::renderer

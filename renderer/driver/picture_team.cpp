#include "renderer/driver/picture_team.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "renderer/distributed/packing.h"

namespace gatelight::renderer {
namespace {

/// The rows of each process begin at a multiple of this.
constexpr int kRowUnit = 4;

/// The sum of a number of each pixel of these tiles.
template <class Number>
std::uint64_t sum_over(const TileGrid& tiles, Number number) {
  std::uint64_t sum = 0;
  std::vector<Pixel> pixels;
  for (int tile = 0; tile < tiles.count(); ++tile) {
    tiles.pixels(tile, pixels);
    for (const Pixel& p : pixels) sum += number(p);
  }
  return sum;
}

}  // namespace

PictureTeam::PictureTeam(const PreparedPicture& picture)
    : threads_(ranks_or_one(picture.options.ranks).of_each(static_cast<double>(picture.threads))),
      all_(ranks_or_one(picture.options.ranks), TileGrid(picture.region), threads_),
      own_(all_.own()) {}

PixelRect PictureTeam::own_rows(const PixelRect& picture) const {
  const double all = std::accumulate(threads_.begin(), threads_.end(), 0.0);
  const auto row_of = [&](int rank) {
    if (rank == all_.ranks.count()) return picture.y1;
    const double before = std::accumulate(threads_.begin(), threads_.begin() + rank, 0.0);
    const auto units = static_cast<int>(std::lround(before / all * picture.height() / kRowUnit));
    return picture.y0 + std::min(units * kRowUnit, picture.height());
  };
  PixelRect rows = picture;
  rows.y0 = row_of(all_.ranks.rank());
  rows.y1 = row_of(all_.ranks.rank() + 1);
  return rows;
}

void PictureTeam::exchange(Film& film, const Shares& shares,
                           const std::function<bool(int rank, int tile)>& wants) const {
  if (all_.ranks.is_single()) return;
  const int self = all_.ranks.rank();
  std::vector<Pixel> pixels;
  std::vector<Bytes> outgoing;
  for (int r = 0; r < all_.ranks.count(); ++r) {
    Packer packer;
    for (int tile = shares.begin(self); r != self && tile < shares.end(self); ++tile) {
      if (!wants(r, tile)) continue;
      all_.tiles.pixels(tile, pixels);
      film.pack(pixels, packer);
    }
    outgoing.push_back(packer.take());
  }
  const std::vector<Bytes> incoming = all_.ranks.exchange(std::move(outgoing));
  for (int r = 0; r < all_.ranks.count(); ++r) {
    Unpacker unpacker(incoming[static_cast<std::size_t>(r)]);
    for (int tile = shares.begin(r); r != self && tile < shares.end(r); ++tile) {
      if (!wants(self, tile)) continue;
      all_.tiles.pixels(tile, pixels);
      film.unpack(pixels, unpacker);
    }
  }
}

void PictureTeam::gather(Film& film) const {
  exchange(film, all_.shares, [](int rank, int) { return rank == 0; });
}

void PictureTeam::rebalance(Film& film, const std::vector<RankWork>& measured) {
  if (all_.ranks.is_single()) return;
  const Shares before = all_.shares;
  if (!all_.shares.rebalance(measured)) return;
  exchange(film, before, [&](int rank, int tile) { return all_.shares.owner(tile) == rank; });
  own_ = all_.own();
}

std::uint64_t PictureTeam::own_samples(const Film& film) const {
  return sum_over(own_, [&](const Pixel& p) { return film.taken(p); });
}

double PictureTeam::samples_per_pixel(const Film& film) const {
  if (all_.ranks.is_single()) return film.samples_per_pixel();
  const std::uint64_t sum = sum_over(own_, [&](const Pixel& p) { return film.count(p); });
  return static_cast<double>(all_.ranks.sum(sum)) / static_cast<double>(film.pixels());
}

}  // namespace gatelight::renderer

#include "renderer/driver/picture_team.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "renderer/distributed/packing.h"

namespace gatelight::renderer {
namespace {

/// The rows of each rank begin at a multiple of this.
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

PictureTeam::PictureTeam(const PixelRect& region, Ranks& ranks, int threads)
    : ranks_(ranks),
      threads_(ranks.of_each(static_cast<double>(threads))),
      tiles_(region),
      shares_(tiles_.count(), threads_),
      own_(tiles_.part(shares_.begin(ranks.rank()), shares_.end(ranks.rank()))) {}

PixelRect PictureTeam::own_rows(const PixelRect& picture) const {
  const double all = std::accumulate(threads_.begin(), threads_.end(), 0.0);
  const auto row_of = [&](int rank) {
    if (rank == ranks_.count()) return picture.y1;
    const double before = std::accumulate(threads_.begin(), threads_.begin() + rank, 0.0);
    const auto units = static_cast<int>(std::lround(before / all * picture.height() / kRowUnit));
    return picture.y0 + std::min(units * kRowUnit, picture.height());
  };
  PixelRect rows = picture;
  rows.y0 = row_of(ranks_.rank());
  rows.y1 = row_of(ranks_.rank() + 1);
  return rows;
}

void PictureTeam::exchange(Film& film, const Shares& shares,
                           const std::function<bool(int rank, int tile)>& wants) const {
  if (ranks_.is_single()) return;
  const int self = ranks_.rank();
  std::vector<Pixel> pixels;
  std::vector<Bytes> outgoing;
  for (int r = 0; r < ranks_.count(); ++r) {
    Packer packer;
    for (int tile = shares.begin(self); r != self && tile < shares.end(self); ++tile) {
      if (!wants(r, tile)) continue;
      tiles_.pixels(tile, pixels);
      film.pack(pixels, packer);
    }
    outgoing.push_back(packer.take());
  }
  const std::vector<Bytes> incoming = ranks_.exchange(std::move(outgoing));
  for (int r = 0; r < ranks_.count(); ++r) {
    Unpacker unpacker(incoming[static_cast<std::size_t>(r)]);
    for (int tile = shares.begin(r); r != self && tile < shares.end(r); ++tile) {
      if (!wants(self, tile)) continue;
      tiles_.pixels(tile, pixels);
      film.unpack(pixels, unpacker);
    }
  }
}

void PictureTeam::gather(Film& film) const {
  exchange(film, shares_, [](int rank, int) { return rank == 0; });
}

void PictureTeam::rebalance(Film& film, const std::vector<RankWork>& measured) {
  if (ranks_.is_single()) return;
  const Shares before = shares_;
  if (!shares_.rebalance(measured)) return;
  exchange(film, before, [&](int rank, int tile) { return shares_.owner(tile) == rank; });
  own_ = tiles_.part(shares_.begin(ranks_.rank()), shares_.end(ranks_.rank()));
}

std::uint64_t PictureTeam::own_samples(const Film& film) const {
  return sum_over(own_, [&](const Pixel& p) { return film.taken(p); });
}

double PictureTeam::samples_per_pixel(const Film& film) const {
  if (ranks_.is_single()) return film.samples_per_pixel();
  const std::uint64_t sum = sum_over(own_, [&](const Pixel& p) { return film.count(p); });
  return static_cast<double>(ranks_.sum(sum)) / static_cast<double>(film.pixels());
}

}  // namespace gatelight::renderer

#include "renderer/driver/film_exchange.h"

#include <utility>
#include <vector>

#include "renderer/distributed/packing.h"

namespace gatelight::renderer {

void exchange_tiles(Film& film, const TileGrid& tiles, const Shares& shares, Ranks& ranks,
                    const std::function<bool(int rank, int tile)>& wants) {
  if (ranks.is_single()) return;
  const int self = ranks.rank();
  std::vector<Pixel> pixels;
  std::vector<Bytes> outgoing;
  for (int r = 0; r < ranks.count(); ++r) {
    Packer packer;
    for (int tile = shares.begin(self); r != self && tile < shares.end(self); ++tile) {
      if (!wants(r, tile)) continue;
      tiles.pixels(tile, pixels);
      film.pack(pixels, packer);
    }
    outgoing.push_back(packer.take());
  }
  const std::vector<Bytes> incoming = ranks.exchange(std::move(outgoing));
  for (int r = 0; r < ranks.count(); ++r) {
    Unpacker unpacker(incoming[static_cast<std::size_t>(r)]);
    for (int tile = shares.begin(r); r != self && tile < shares.end(r); ++tile) {
      if (!wants(self, tile)) continue;
      tiles.pixels(tile, pixels);
      film.unpack(pixels, unpacker);
    }
  }
}

void gather_film(Film& film, const TileGrid& tiles, const Shares& shares, Ranks& ranks) {
  exchange_tiles(film, tiles, shares, ranks, [](int rank, int) { return rank == 0; });
}

}  // namespace gatelight::renderer

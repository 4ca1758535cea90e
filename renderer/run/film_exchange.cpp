#include "renderer/run/film_exchange.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "renderer/ranks/packing.h"

namespace gatelight::renderer {

void exchange_tiles(Film& film, const TileGrid& tiles, const Shares& shares, Ranks& ranks,
                    const std::function<bool(int rank, int tile)>& wants) {
  if (ranks.alone()) return;
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

Picture exchange_rows(const Film& film, const TileGrid& tiles, const Shares& shares, Ranks& ranks,
                      const std::function<std::pair<int, int>(int rank)>& rows_of, tbb::task_arena& arena) {
  const int self = ranks.rank();
  const std::pair<int, int> rows = rows_of(self);
  const int top = rows.first, bottom = rows.second;
  if (ranks.alone()) return arena.execute([&] { return film.resolve(top, bottom); });

  std::vector<TileGrid> of_ranks;
  for (int r = 0; r < ranks.count(); ++r) of_ranks.push_back(tiles.part(shares.begin(r), shares.end(r)));
  // The rows where this rank has pixels.
  const auto has_some = [&](int y) {
    const auto [begin, end] = of_ranks[static_cast<std::size_t>(self)].columns(y);
    return begin < end;
  };
  int first = film.rect().y0, end = film.rect().y1;
  while (first < end && !has_some(first)) ++first;
  while (first < end && !has_some(end - 1)) --end;
  Picture mine = arena.execute([&] { return film.resolve(first, end); });

  Picture result{.width = mine.width,
                 .height = bottom - top,
                 .x0 = mine.x0,
                 .y0 = top,
                 .full_width = mine.full_width,
                 .full_height = mine.full_height};
  const auto pixels = static_cast<std::size_t>(result.width) * static_cast<std::size_t>(result.height);
  for (const Layer& layer : mine.layers) {
    result.layers.push_back({layer.name, layer.channels, {}, layer.full_precision});
    result.layers.back().values.resize(pixels * layer.channels.size());
  }
  /// Visits what a rank has of the rows that another wants: the values of each layer, row after row.
  const auto each_piece = [&](Picture& picture, int has, int wants, const auto& visit) {
    const auto [from, to] = rows_of(wants);
    for (int y = from; y < to; ++y) {
      const auto [left, right] = of_ranks[static_cast<std::size_t>(has)].columns(y);
      if (left == right) continue;
      const auto begin = static_cast<std::size_t>(y - picture.y0) * static_cast<std::size_t>(picture.width) +
                         static_cast<std::size_t>(left - picture.x0);
      for (Layer& layer : picture.layers) {
        const std::size_t channels = layer.channels.size();
        visit(std::span(layer.values)
                  .subspan(begin * channels, static_cast<std::size_t>(right - left) * channels));
      }
    }
  };
  std::vector<Bytes> outgoing(static_cast<std::size_t>(ranks.count()));
  std::vector<std::span<float>> own;
  each_piece(mine, self, self, [&](std::span<float> values) { own.push_back(values); });
  auto piece = own.begin();
  each_piece(result, self, self, [&](std::span<float> values) {
    std::copy_n((piece++)->begin(), values.size(), values.begin());
  });
  for (int r = 0; r < ranks.count(); ++r) {
    if (r == self) continue;
    Packer packer;
    each_piece(mine, self, r, [&](std::span<float> values) { packer.add_all(values); });
    outgoing[static_cast<std::size_t>(r)] = packer.take();
  }
  mine = {};
  const std::vector<Bytes> incoming = ranks.exchange(std::move(outgoing));
  for (int r = 0; r < ranks.count(); ++r) {
    if (r == self) continue;
    Unpacker unpacker(incoming[static_cast<std::size_t>(r)]);
    each_piece(result, r, self, [&](std::span<float> values) { unpacker.read_all(values); });
  }
  return result;
}

void gather_film(Film& film, const TileGrid& tiles, const Shares& shares, Ranks& ranks) {
  exchange_tiles(film, tiles, shares, ranks, [](int rank, int) { return rank == 0; });
}

}  // namespace gatelight::renderer

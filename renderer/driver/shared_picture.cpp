// The collective work of the ranks of a picture: statistics, tiles, and Cryptomattes.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "renderer/distributed/packing.h"
#include "renderer/driver/implementation.h"
#include "renderer/transport/cryptomatte_pass.h"

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

std::uint64_t Renderer::Implementation::samples_of_rank(const Film& film) const {
  return sum_over(own, [&](const Pixel& p) { return film.taken(p); });
}

void Renderer::Implementation::add_other_ranks(RenderStatistics& sum, const Training& training) const {
  if (ranks.is_single()) return;
  struct Counts {
    RankStatistics of_rank;
    RayCounts rays;
    std::uint64_t nonfinite, clamped, queries, negative_answers, unstored_hits;
  };
  Ranks::Traffic traffic = ranks.traffic();
  traffic.bytes_sent -= traffic_before.bytes_sent;
  traffic.waiting_seconds -= traffic_before.waiting_seconds;
  const CacheSession* const session = training.session.get();
  const auto all = one_of_each(ranks, Counts{{.threads = threads,
                                              .samples = sum.samples,
                                              .training_paths = session ? session->paths_of_rank() : 0,
                                              .record_bytes = session ? session->record_bytes() : 0,
                                              .seconds = seconds_since(begin),
                                              .bytes_sent = traffic.bytes_sent,
                                              .waiting_seconds = traffic.waiting_seconds},
                                             sum.rays,
                                             sum.nonfinite,
                                             sum.clamped,
                                             sum.cache.queries,
                                             sum.cache.negative_answers,
                                             sum.cache.unstored_hits});
  sum.ranks.clear();
  sum.threads = 0;
  sum.rays = {};
  sum.samples = sum.nonfinite = sum.clamped = 0;
  sum.cache.queries = sum.cache.negative_answers = sum.cache.unstored_hits = 0;
  for (const Counts& counts : all) {
    sum.ranks.push_back(counts.of_rank);
    sum.threads += counts.of_rank.threads;
    sum.rays.add(counts.rays);
    sum.samples += counts.of_rank.samples;
    sum.nonfinite += counts.nonfinite;
    sum.clamped += counts.clamped;
    sum.cache.queries += counts.queries;
    sum.cache.negative_answers += counts.negative_answers;
    sum.cache.unstored_hits += counts.unstored_hits;
  }
  sum.nonfinite_samples = joined(ranks, std::move(sum.nonfinite_samples));
  keep_first(sum.nonfinite_samples);
}

double Renderer::Implementation::samples_per_pixel(const Film& film) const {
  if (ranks.is_single()) return film.samples_per_pixel();
  const std::uint64_t sum = sum_over(own, [&](const Pixel& p) { return film.count(p); });
  return static_cast<double>(sum_of_all(ranks, sum)) / static_cast<double>(film.pixels());
}

void Renderer::Implementation::rebalance(Film& film, const std::vector<RankWork>& measured) {
  if (ranks.is_single()) return;
  const Shares before = shares;
  if (!shares.rebalance(measured)) return;
  exchange_tiles(film, tiles, before, ranks, [&](int rank, int tile) { return shares.owner(tile) == rank; });
  own = tiles.part(shares.begin(ranks.rank()), shares.end(ranks.rank()));
}

Cryptomattes Renderer::Implementation::cryptomattes() {
  if (options.cryptomattes.empty()) return {};
  const Clock::time_point start = Clock::now();
  const PixelRect whole = region_of_picture();
  const double all = std::accumulate(threads_of_ranks.begin(), threads_of_ranks.end(), 0.0);
  const auto row_of = [&](int rank) {
    const double before = std::accumulate(threads_of_ranks.begin(), threads_of_ranks.begin() + rank, 0.0);
    if (rank == ranks.count()) return whole.y1;
    const auto units = static_cast<int>(std::lround(before / all * whole.height() / kRowUnit));
    return whole.y0 + std::min(units * kRowUnit, whole.height());
  };
  PixelRect rows = whole;
  rows.y0 = row_of(ranks.rank());
  rows.y1 = row_of(ranks.rank() + 1);
  const Camera eye(view, picture_options.width, picture_options.height);
  const FilterSampler of_picture(picture_options.filter, picture_options.filter_width);
  Cryptomattes mattes =
      arena.execute([&] { return trace_cryptomattes(*world, eye, of_picture, picture_options, rows); });
  for (Layer& layer : mattes.layers) layer.values = joined_at_first(ranks, std::move(layer.values));
  statistics.cryptomatte_seconds = seconds_since(start);
  return mattes;
}

}  // namespace gatelight::renderer

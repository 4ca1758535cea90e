// What the ranks of a picture do together: its film, and the finished picture.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "renderer/ranks/packing.h"
#include "renderer/run/adaptive_sampling.h"
#include "renderer/run/implementation.h"
#include "renderer/transport/cryptomatte_pass.h"

namespace gatelight::renderer {
namespace {

/// The layers' values of some rows, as rank 0 joins them.
template <class Visit>
void each_array(FinishedPicture& finished, Visit visit) {
  for (Layer& layer : finished.picture.layers) visit(layer.values);
  Reconstruction& r = finished.reconstruction;
  for (auto& half : r.halves) visit(half);
  for (auto& half : r.noise) visit(half);
  visit(r.kept_and_lost);
  visit(finished.alpha);
}

/// Rank 0 gets the rows of all ranks in `mine`.
void join_rows(FinishedPicture& mine, int height, Ranks& ranks) {
  Packer packer;
  each_array(mine, [&](const auto& values) {
    packer.add(static_cast<std::uint64_t>(values.size()));
    packer.add_all(std::span(values));
  });
  std::vector<Bytes> outgoing(static_cast<std::size_t>(ranks.count()));
  if (!ranks.first()) outgoing[0] = packer.take();
  const std::vector<Bytes> incoming = ranks.exchange(std::move(outgoing));
  if (!ranks.first()) {
    mine = {};
    return;
  }
  for (std::size_t r = 1; r < incoming.size(); ++r) {
    Unpacker unpacker(incoming[r]);
    each_array(mine, [&](auto& values) {
      const std::size_t before = values.size();
      values.resize(before + static_cast<std::size_t>(unpacker.read<std::uint64_t>()));
      unpacker.read_all(std::span(values).subspan(before));
    });
  }
  mine.picture.height = height;
}

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
  if (ranks.alone()) return;
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
  if (ranks.alone()) return film.samples_per_pixel();
  const std::uint64_t sum = sum_over(own, [&](const Pixel& p) { return film.count(p); });
  return static_cast<double>(sum_of_all(ranks, sum)) / static_cast<double>(film.pixels());
}

void Renderer::Implementation::rebalance(Film& film, const std::vector<RankWork>& measured) {
  if (ranks.alone()) return;
  const Shares before = shares;
  if (!shares.rebalance(measured)) return;
  exchange_tiles(film, tiles, before, ranks, [&](int rank, int tile) { return shares.owner(tile) == rank; });
  own = tiles.part(shares.begin(ranks.rank()), shares.end(ranks.rank()));
}

double Renderer::Implementation::share_of_rows() const {
  if (ranks.alone()) return 1.0;
  const std::vector<int> begins = rows_of_ranks();
  int most = 0;
  for (std::size_t r = 0; r + 1 < begins.size(); ++r) most = std::max(most, begins[r + 1] - begins[r]);
  return std::min(1.0, static_cast<double>(most + 2 * kRowMargin) / region.height());
}

std::vector<int> Renderer::Implementation::rows_of_ranks() const {
  const int height = region.height();
  const double all = std::accumulate(threads_of_ranks.begin(), threads_of_ranks.end(), 0.0);
  std::vector<int> begins = {0};
  double before = 0.0;
  for (const double n : threads_of_ranks) {
    before += n;
    const auto units = static_cast<int>(std::lround(before / all * height / kRowUnit));
    begins.push_back(std::min(units * kRowUnit, height));
  }
  begins.back() = height;
  return begins;
}

std::pair<int, int> Renderer::Implementation::rows_with_margin(int rank) const {
  const std::vector<int> begins = rows_of_ranks();
  const auto r = static_cast<std::size_t>(rank);
  // A rank without rows joins the others with a few.
  const int margin = begins[r] < begins[r + 1] ? kRowMargin : kRowUnit;
  return {std::max(begins[r] - margin, 0), std::min(begins[r + 1] + margin, region.height())};
}

SharedRows Renderer::Implementation::shared_rows() const {
  SharedRows rows = SharedRows::all(region.height());
  if (ranks.alone()) return rows;
  const std::vector<int> begins = rows_of_ranks();
  const auto self = static_cast<std::size_t>(ranks.rank());
  rows.first = begins[self];
  rows.end = begins[self + 1];
  std::tie(rows.top, rows.bottom) = rows_with_margin(ranks.rank());
  rows.join = [this](std::vector<double> mine) { return joined(ranks, std::move(mine)); };
  return rows;
}

Picture Renderer::Implementation::sampled_rows(const Film& film) {
  const auto rows_of = [&](int rank) {
    const auto [top, bottom] = rows_with_margin(rank);
    return std::pair(region.y0 + top, region.y0 + bottom);
  };
  return exchange_rows(film, tiles, shares, ranks, rows_of, arena);
}

Cryptomattes Renderer::Implementation::cryptomattes() {
  if (options.cryptomattes.empty()) return {};
  const Clock::time_point start = Clock::now();
  const std::vector<int> begins = rows_of_ranks();
  const auto self = static_cast<std::size_t>(ranks.rank());
  PixelRect rows = region;
  rows.y0 = region.y0 + begins[self];
  rows.y1 = region.y0 + begins[self + 1];
  Cryptomattes mattes =
      arena.execute([&] { return trace_cryptomattes(*world, camera, filter, options, rows); });
  for (Layer& layer : mattes.layers) layer.values = joined_at_first(ranks, std::move(layer.values));
  statistics.cryptomatte_seconds = seconds_since(start);
  return mattes;
}

FinishedPicture Renderer::Implementation::finish(Film& film) {
  const Clock::time_point start = Clock::now();
  const double spp = samples_per_pixel(film);
  const SeenLight better = smoother_edges(spp);
  const CaughtShadows shadows = caught_shadows(spp);
  FinishedPicture finished;
  if (ranks.alone() || !options.reconstruct) {
    gather(film);
    if (ranks.first()) finished = finished_picture(film, options, arena, better, shadows);
  } else {
    Picture samples = sampled_rows(film);
    arena.execute(
        [&] { finished = finished_rows(std::move(samples), shared_rows(), options, better, shadows); });
    join_rows(finished, region.height(), ranks);
    if (ranks.first()) arena.execute([&] { complete(finished, spp, options); });
    finished.reconstruct_seconds = seconds_since(start);
  }
  if (ranks.first()) finished.picture.view = camera.matrices(scene.origin);
  return finished;
}

double Renderer::Implementation::adapt_density(Film& film, const Reconstruction* known) {
  const Clock::time_point start = Clock::now();
  FinishedPicture finished;
  if (!known) {
    Picture samples = sampled_rows(film);
    finished.reconstruction =
        arena.execute([&] { return reconstruction_of(std::move(samples), shared_rows(), options); });
    if (!ranks.alone()) join_rows(finished, region.height(), ranks);
    known = &finished.reconstruction;
  }
  if (ranks.alone()) {
    arena.execute([&] { film.follow(make_density(region, *known)); });
    return seconds_since(start);
  }
  Bytes bytes;
  if (ranks.first()) {
    Packer packer;
    const SampleDensity density = arena.execute([&] { return make_density(region, *known); });
    for (const std::vector<float>& half : density.values()) packer.add_all(std::span(half));
    bytes = packer.take();
  }
  ranks.broadcast(bytes);
  Unpacker unpacker(bytes);
  std::array<std::vector<float>, 2> values;
  for (std::vector<float>& half : values) {
    half.resize(film.pixels());
    unpacker.read_all(std::span(half));
  }
  film.follow(SampleDensity::restore(region, std::move(values)));
  return seconds_since(start);
}

}  // namespace gatelight::renderer

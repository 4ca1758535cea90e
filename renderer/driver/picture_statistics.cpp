#include "renderer/driver/picture_statistics.h"

#include <utility>

#include "renderer/distributed/collectives.h"

namespace gatelight::renderer {

PictureStatistics::PictureStatistics(const RenderContext& context)
    : context_(context), traffic_before_(context.tiles.ranks().traffic()) {}

RenderStatistics PictureStatistics::sum_up(const Film& film, const Training* training,
                                           const SampleLoop* loop) const {
  RenderStatistics sum = context_.picture.statistics;
  sum.cryptomatte_seconds = cryptomatte_seconds;
  sum.samples = context_.tiles.own_samples(film);
  SampleCounts counts;
  if (loop) {
    sum.render_seconds = loop->seconds();
    sum.spp = loop->done() * context_.picture.options.denoise.film_pixels_per_pixel();
    sum.rays = loop->pass().rays();
    counts = loop->pass().counts();
  }
  if (training) {
    counts.add(training->counts());
    training->add_to(sum);
  }
  if (loop) loop->pass().add_to(sum.cache);
  sum.nonfinite = counts.nonfinite;
  sum.clamped = counts.clamped;
  sum.nonfinite_samples = std::move(counts.located);
  add_other_ranks(sum, training ? &training->session() : nullptr);
  add_earlier(sum, earlier);
  sum.resumed_seconds = earlier.render_seconds;
  return sum;
}

/// Sums up the counts of all ranks, and keeps those of each rank.
void PictureStatistics::add_other_ranks(RenderStatistics& sum, const CacheSession* session) const {
  Ranks& ranks = context_.tiles.ranks();
  if (ranks.is_single()) return;
  struct Counts {
    RankStatistics of_rank;
    RayCounts rays;
    std::uint64_t nonfinite, clamped, queries, negative_answers, unstored_hits;
  };
  const Ranks::Traffic traffic = ranks.traffic();
  const Counts mine{{.threads = sum.threads,
                     .samples = sum.samples,
                     .training_paths = session ? session->paths_of_rank() : 0,
                     .record_bytes = session ? session->record_bytes() : 0,
                     .seconds = seconds_since(begin),
                     .bytes_sent = traffic.bytes_sent - traffic_before_.bytes_sent,
                     .waiting_seconds = traffic.waiting_seconds - traffic_before_.waiting_seconds},
                    sum.rays,
                    sum.nonfinite,
                    sum.clamped,
                    sum.cache.queries,
                    sum.cache.negative_answers,
                    sum.cache.unstored_hits};
  sum.threads = 0;
  sum.rays = {};
  sum.samples = sum.nonfinite = sum.clamped = 0;
  sum.cache.queries = sum.cache.negative_answers = sum.cache.unstored_hits = 0;
  for (const Counts& counts : one_of_each(ranks, mine)) {
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

}  // namespace gatelight::renderer

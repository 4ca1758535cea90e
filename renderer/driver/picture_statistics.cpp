#include "renderer/driver/picture_statistics.h"

#include <array>
#include <cstdint>
#include <utility>

namespace gatelight::renderer {

PictureStatistics::PictureStatistics(const RenderContext& context)
    : context_(context), traffic_before_(context.team.traffic()) {}

RenderStatistics PictureStatistics::sum_up(const Film& film, const Training* training,
                                           const SampleLoop* loop) const {
  RenderStatistics sum = context_.picture.statistics;
  sum.cryptomatte_seconds = cryptomatte_seconds;
  sum.samples = context_.team.own_samples(film);
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
  add_others(sum, training ? &training->session() : nullptr);
  add_earlier(sum, earlier);
  sum.resumed_seconds = earlier.render_seconds;
  return sum;
}

/// Sums up the counts of all processes, and keeps those of each.
void PictureStatistics::add_others(RenderStatistics& sum, const CacheSession* session) const {
  const PictureTeam& team = context_.team;
  if (team.is_alone()) return;
  constexpr std::size_t kCounted = 6;
  const std::array<std::uint64_t*, kCounted> counted = {&sum.samples,
                                                        &sum.nonfinite,
                                                        &sum.clamped,
                                                        &sum.cache.queries,
                                                        &sum.cache.negative_answers,
                                                        &sum.cache.unstored_hits};
  struct Counts {
    ProcessStatistics own;
    RayCounts rays;
    std::array<std::uint64_t, kCounted> numbers{};
  };
  const auto share = session ? session->exchange().share : RecordExchange::Share{};
  const Traffic traffic = team.traffic();
  Counts mine{{.threads = sum.threads,
               .samples = sum.samples,
               .training_paths = share.paths,
               .record_bytes = share.bytes,
               .seconds = seconds_since(begin),
               .bytes_sent = traffic.bytes_sent - traffic_before_.bytes_sent,
               .waiting_seconds = traffic.waiting_seconds - traffic_before_.waiting_seconds},
              sum.rays};
  for (std::size_t i = 0; i < kCounted; ++i) mine.numbers[i] = std::exchange(*counted[i], 0);
  sum.threads = 0;
  sum.rays = {};
  for (const Counts& counts : team.of_each(mine)) {
    sum.team.push_back(counts.own);
    sum.threads += counts.own.threads;
    sum.rays.add(counts.rays);
    for (std::size_t i = 0; i < kCounted; ++i) *counted[i] += counts.numbers[i];
  }
  sum.nonfinite_samples = team.joined(std::move(sum.nonfinite_samples));
  keep_first(sum.nonfinite_samples);
}

}  // namespace gatelight::renderer

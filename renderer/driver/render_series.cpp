#include "renderer/driver/render_series.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "base/clock.h"
#include "renderer/driver/picture_stages.h"
#include "renderer/driver/picture_statistics.h"
#include "renderer/driver/sample_loop.h"
#include "renderer/driver/training.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {
namespace {

void check_points(const char* option, const std::vector<int>& points, int least) {
  const bool ascending =
      std::adjacent_find(points.begin(), points.end(), std::greater_equal()) == points.end();
  if (points.empty() || points.front() < least || !ascending)
    throw BadOption({option, fmt::format("{}", fmt::join(points, ",")), "",
                     fmt::format("a series of numbers of at least {}, each greater than the last", least)});
}

void check_series(const Series& series, const RenderOptions& options) {
  const bool caches = uses_cache(options.integrator);
  const auto refuse = [](bool given, const char* option, const char* expected = "none") {
    if (given) throw BadOption({option, "", "a series has none of it", expected});
  };
  refuse(caches && !series.spp.empty(), "spp", "`train-steps` with nao and nrc");
  refuse(!caches && !series.train_steps.empty(), "train-steps", "`spp` with path and ao");
  caches ? check_points("train-steps", series.train_steps, 0) : check_points("spp", series.spp, 1);
  refuse(options.time_limit_seconds > 0.0, "time-limit");
  refuse(options.max_error > 0.0, "max-error");
  if (!caches && series.spp.size() > 1 && options.sampler == SamplerKind::screen)
    throw BadOption(
        {"sampler", "screen", "its samples depend on `spp`", "sobol or independent for a series of spp"});
  refuse(caches && options.cache.train_seconds > 0.0, "train-time");
  refuse(!options.checkpoint.file.empty(), "checkpoint");
  refuse(caches && !options.cache.cache_out.empty(), "cache-out");
  const int of_pixel = options.denoise.film_pixels_per_pixel();
  for (const int spp : series.spp) {
    if (spp % of_pixel != 0)
      throw BadOption({"spp", fmt::format("{}", spp), "",
                       fmt::format("a multiple of {}, with `supersampling`", of_pixel)});
  }
}

/// The pictures of one training, or of one rendering without a cache. The functions return false where the
/// caller stops them.
class SeriesRun {
 public:
  SeriesRun(const RenderContext& context, const SeriesPicture& picture, RenderStatistics& statistics)
      : context_(context), options_(context.picture.options), picture_(picture), statistics_(statistics) {}

  bool render_steps(const std::vector<int>& points) {
    Training training(context_, nullptr);
    mattes_ = make_cryptomattes(context_, sums_.cryptomatte_seconds);
    training.expect_steps(points.back());
    Film taught = context_.picture.make_film();
    for (std::size_t point = 0; point < points.size(); ++point) {
      // A point within a group of steps ends that group early, for its own picture only.
      const auto steps = static_cast<std::uint64_t>(points[point]);
      const std::uint64_t between_groups =
          training.session().last_group_end(training.first_step() + steps) - training.first_step();
      std::optional<std::pair<Training::Snapshot, Film>> before;
      for (const std::uint64_t end : {between_groups, steps}) {
        if (end > between_groups && point + 1 < points.size()) before.emplace(training.snapshot(), taught);
        training.train(static_cast<int>(end), taught);
        if (training.stopped()) return false;
      }
      Film film = taught;
      SampleLoop loop(context_, film, &training, options_.spp);
      if (!run_passes(loop, options_.spp)) return false;
      loop.report_end();
      if (!give(point, film, &training, loop)) return false;
      if (loop.over()) return point + 1 == points.size();
      if (before) {
        training.return_to(std::move(before->first));
        taught = std::move(before->second);
      }
    }
    return true;
  }

  bool render_samples(const std::vector<int>& points) {
    mattes_ = make_cryptomattes(context_, sums_.cryptomatte_seconds);
    Film film = context_.picture.make_film();
    SampleLoop loop(context_, film, nullptr, context_.picture.samples_of_film(points.back()));
    for (std::size_t point = 0; point < points.size(); ++point) {
      if (!run_passes(loop, context_.picture.samples_of_film(points[point]))) return false;
      if (point + 1 == points.size()) loop.report_end();
      const Clock::time_point start = Clock::now();
      if (!give(point, film, nullptr, loop)) return false;
      loop.leave_out(seconds_since(start));
    }
    return true;
  }

 private:
  static bool run_passes(SampleLoop& loop, int goal) {
    while (loop.done() < goal) {
      if (loop.over()) return false;
      loop.run_pass(goal);
    }
    return true;
  }

  /// Gives the caller the picture of a point.
  bool give(std::size_t point, Film& film, const Training* training, const SampleLoop& loop) {
    statistics_ = sums_.sum_up(film, training, &loop);
    FinishedPicture finished = finish(context_, film, loop.stopped(), statistics_);
    if (finished.stopped) return false;
    add_cryptomattes(finished.picture, mattes_);
    picture_(static_cast<int>(point), finished.picture, statistics_);
    return true;
  }

  RenderContext context_;
  const RenderOptions& options_;
  const SeriesPicture& picture_;
  RenderStatistics& statistics_;  ///< of the last picture
  PictureStatistics sums_{context_};
  Cryptomattes mattes_;
};

}  // namespace

bool render_series(const RenderContext& context, const Series& series, const SeriesPicture& picture,
                   RenderStatistics& statistics) {
  const RenderOptions& options = context.picture.options;
  check_series(series, options);
  if (!context.team.is_alone()) throw BadOption("a series by several processes: expected one");
  SeriesRun run(context, picture, statistics);
  return uses_cache(options.integrator) ? run.render_steps(series.train_steps)
                                        : run.render_samples(series.spp);
}

}  // namespace gatelight::renderer

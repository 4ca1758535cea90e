#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <tuple>
#include <utility>

#include "base/platform/flush_denormals.h"
#include "renderer/driver/finished_picture.h"
#include "renderer/driver/implementation.h"
#include "renderer/driver/sample_loop.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {
namespace {

void check_points(const char* name, const std::vector<int>& points, int least) {
  if (points.empty()) throw BadOption(fmt::format("a series without {}: expected at least one", name));
  const bool ascending =
      std::adjacent_find(points.begin(), points.end(), std::greater_equal()) == points.end();
  if (points.front() < least || !ascending) {
    throw BadOption(
        fmt::format("a series of {} {}: expected numbers of at least {}, each greater than the last", name,
                    fmt::join(points, ","), least));
  }
}

void check_series(const Series& series, const RenderOptions& options) {
  const bool caches = uses_cache(options.integrator);
  if (!(caches ? series.spp : series.train_steps).empty()) {
    throw BadOption(caches ? "a series of spp: expected train_steps for nao and nrc"
                           : "a series of train_steps: expected spp for path and ao");
  }
  caches ? check_points("train_steps", series.train_steps, 0) : check_points("spp", series.spp, 1);
  const auto refuse = [](bool given, const char* what) {
    if (given) throw BadOption(fmt::format("a series with {}: expected none", what));
  };
  refuse(options.time_limit_seconds > 0.0, "a time limit");
  refuse(options.max_error > 0.0, "an error at which it ends");
  refuse(caches && options.cache.train_seconds > 0.0, "a time limit of training");
  refuse(!options.checkpoint.file.empty(), "a checkpoint");
  refuse(caches && !options.cache.cache_out.empty(), "a cache file to write");
  const int of_pixel = options.denoise.parts();
  for (const int spp : series.spp) {
    if (spp % of_pixel != 0)
      throw BadOption(fmt::format("a series of spp with {}: expected multiples of {}, with supersampling",
                                  spp, of_pixel));
  }
}

}  // namespace

bool Renderer::render_series(const Series& series, const SeriesPicture& picture, const Callbacks& callbacks) {
  const FlushDenormals flush;
  Implementation& self = *implementation_;
  check_series(series, self.options);
  if (!self.ranks.is_single()) throw BadOption("a series with several ranks: expected one");
  return uses_cache(self.options.integrator) ? self.render_step_series(series.train_steps, picture, callbacks)
                                             : self.render_sample_series(series.spp, picture, callbacks);
}

bool Renderer::Implementation::render_step_series(const std::vector<int>& train_steps,
                                                  const SeriesPicture& picture, const Callbacks& callbacks) {
  Training training = begin_training(
      nullptr, options.cache.cache_in.empty() ? SceneFingerprint{} : scene_fingerprint(), callbacks);
  training.chosen = false;
  const Cryptomattes mattes = cryptomattes();
  training.all_steps = train_steps.back();
  CacheSession& session = *training.session;
  Film taught = make_film();
  for (std::size_t point = 0; point < train_steps.size(); ++point) {
    // A point within a group of steps ends that group early, for its own picture only.
    const auto steps = static_cast<std::uint64_t>(train_steps[point]);
    const std::uint64_t between_groups =
        session.last_group_end(training.first_step + steps) - training.first_step;
    std::optional<CacheSession::Snapshot> snapshot;
    std::optional<std::pair<Film, SampleCounts>> taught_before;
    for (const std::uint64_t end : {between_groups, steps}) {
      if (end > between_groups && point + 1 < train_steps.size()) {
        snapshot = session.snapshot();
        taught_before.emplace(taught, training.counts);
      }
      training.steps = static_cast<int>(end);
      train(training, taught, callbacks, {});
      if (training.stopped) return false;
    }
    Film film = taught;
    const std::unique_ptr<Pass> pass = make_pass(training);
    SampleLoop loop(arena, options, callbacks, *pass, film, options.spp, ranks);
    while (loop.done() < options.spp) {
      if (loop.over()) return false;
      loop.run_pass(options.spp);
    }
    statistics = sum_up(loop.done(), loop.seconds(), film, pass.get(), training, {});
    statistics.interrupted = false;
    loop.report_end();
    FinishedPicture finished = finish(film, callbacks, loop.stopped());
    if (finished.stopped) return false;
    add_statistics(finished);
    add_cryptomattes(finished.picture, mattes);
    picture(static_cast<int>(point), finished.picture, statistics);
    if (loop.over()) return point + 1 == train_steps.size();
    if (snapshot) {
      session.return_to(*snapshot);
      std::tie(taught, training.counts) = std::move(*taught_before);
    }
  }
  return true;
}

bool Renderer::Implementation::render_sample_series(const std::vector<int>& spp, const SeriesPicture& picture,
                                                    const Callbacks& callbacks) {
  const Cryptomattes mattes = cryptomattes();
  Film film = make_film();
  Training untrained;
  const std::unique_ptr<Pass> pass = make_pass(untrained);
  SampleLoop loop(arena, options, callbacks, *pass, film, samples_of_film(spp.back()), ranks);
  for (std::size_t point = 0; point < spp.size(); ++point) {
    const int goal = samples_of_film(spp[point]);
    while (loop.done() < goal) {
      if (loop.over()) return false;
      loop.run_pass(goal);
    }
    statistics = sum_up(loop.done(), loop.seconds(), film, pass.get(), untrained, {});
    statistics.interrupted = false;
    if (point + 1 == spp.size()) loop.report_end();
    const Clock::time_point start = Clock::now();
    FinishedPicture finished = finish(film, callbacks, loop.stopped());
    if (finished.stopped) return false;
    add_statistics(finished);
    add_cryptomattes(finished.picture, mattes);
    picture(static_cast<int>(point), finished.picture, statistics);
    loop.leave_out(seconds_since(start));
  }
  return true;
}

}  // namespace gatelight::renderer

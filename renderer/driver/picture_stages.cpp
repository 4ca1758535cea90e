#include "renderer/driver/picture_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/clock.h"
#include "renderer/denoise/denoise_time.h"
#include "renderer/transport/cryptomatte_pass.h"
#include "renderer/transport/shadow_catcher.h"

namespace gatelight::renderer {
namespace {

/// Points of a pixel for the shadow catcher under a time limit, whose plan needs their number in advance.
constexpr int kTimedShadowPoints = 64;

CaughtShadows caught_shadows(const PreparedPicture& picture, double samples_per_pixel) {
  constexpr int kFewest = 32, kMax = 512;
  if (picture.world->catchers.empty()) return {};
  const int wanted = std::clamp(static_cast<int>(samples_per_pixel), kFewest, kMax);
  const int points = picture.options.time_limit_seconds > 0.0 ? kTimedShadowPoints : wanted;
  return [&picture, points](const PixelRect& rect) {
    return catch_shadows(*picture.world, picture.camera, picture.filter, picture.options, rect, points);
  };
}

Finishing finishing(const PreparedPicture& picture, double samples_per_pixel, DenoiseProgress progress) {
  return {.options = picture.options,
          .denoiser = picture.denoiser.get(),
          .scale = picture.scale,
          .noisy_guides = picture.noisy_guides,
          .shadows = caught_shadows(picture, samples_per_pixel),
          .progress = std::move(progress)};
}

/// For the caller's arena.
double time_denoiser(const PreparedPicture& picture) {
  if (!picture.denoiser) return 0.0;
  double seconds = 0.0;
  failure_to_denoise([&] {  // finish() reports it
    seconds = expect_denoise_seconds(*picture.denoiser, picture.options_of_picture.denoise,
                                     picture.region.width(), picture.region.height());
  });
  return picture.options.background.is_separate() ? 1.5 * seconds : seconds;
}

/// For the caller's arena.
double time_shadows(const PreparedPicture& picture) {
  constexpr int kPoints = 4, kWidth = 128;
  if (picture.world->catchers.empty()) return 0.0;
  const int whole = picture.region.width(), width = std::min(whole, kWidth);
  PixelRect strip = picture.region;
  strip.x0 += (whole - width) / 2;
  strip.x1 = strip.x0 + width;
  const Clock::time_point start = Clock::now();
  catch_shadows(*picture.world, picture.camera, picture.filter, picture.options, strip, kPoints);
  return seconds_since(start) * kTimedShadowPoints / kPoints * whole / width;
}

}  // namespace

Cryptomattes make_cryptomattes(const RenderContext& context, double& seconds) {
  const PreparedPicture& picture = context.picture;
  const RenderOptions& options = picture.options_of_picture;
  if (options.cryptomattes.empty()) return {};
  const Clock::time_point start = Clock::now();
  const PixelRect rows = context.team.own_rows(picture.region_of_picture());
  const Camera camera = picture.camera_of_size(options.width, options.height);
  const FilterSampler filter(options.filter, options.filter_width);
  Cryptomattes mattes = picture.arena.execute(
      [&] { return trace_cryptomattes(*picture.world, camera, filter, options, rows); });
  for (Layer& layer : mattes.layers) layer.values = context.team.joined_rows(std::move(layer.values));
  seconds += seconds_since(start);
  if (!context.team.finishes()) return {};
  return mattes;
}

/// Whether a frame takes over light of the one before. A pixel of a blurred object shows what is behind it,
/// too.
bool carries_light(const PreparedPicture& picture) {
  const bool blurs = picture.scene.shutter.is_open && picture.scene.motion.instances;
  return picture.denoiser && picture.options.denoise.temporal && picture.scale.factor() == 1 && !blurs;
}

FinishedPicture finish(const RenderContext& context, Film& film, bool stopped, RenderStatistics& statistics,
                       FrameMemory* memory) {
  const PreparedPicture& picture = context.picture;
  const double spp = context.team.samples_per_pixel(film);
  context.team.gather(film);
  FinishedPicture finished;
  if (context.team.finishes()) {
    const auto progress = [&callbacks = context.callbacks, stopped, start = Clock::now()](double done) {
      if (callbacks.progress)
        callbacks.progress({.phase = Phase::denoise, .fraction = done, .seconds = seconds_since(start)});
      if (callbacks.abandon && callbacks.abandon()) return false;
      return stopped || !callbacks.stop || !callbacks.stop();
    };
    Finishing how = finishing(picture, spp, progress);
    std::optional<Reuse> reuse;
    if (memory && carries_light(picture)) {
      reuse = picture.arena.execute([&] { return memory->reuse(picture, film); });
      statistics.reused = reuse->share;
      how.after_denoising = [&](DenoisedRows& denoised) {
        picture.arena.execute([&] { mix_light(*reuse, film.rect(), denoised.color); });
        memory->keep(picture, denoised.color, *reuse);
      };
    }
    if (memory) how.motion = picture.arena.execute([&] { return memory->motion(picture); });
    finished = finished_picture(film, how, picture.arena);
    context.callbacks.check_abandoned();
    finished.picture.view = picture.camera.matrices(picture.scene.origin);
  }
  statistics.denoise_seconds = finished.denoise_seconds;
  statistics.denoiser =
      finished.denoised ? fmt::format("Open Image Denoise {}", picture.chosen_denoiser.library->version) : "";
  statistics.denoise_failure = finished.failure;
  statistics.estimated_error = finished.estimated_error;
  return finished;
}

void prepare_to_finish(const PreparedPicture& picture) {
  if (!picture.denoiser) return;
  const RenderOptions& options = picture.options;
  failure_to_denoise([&] {  // finish() reports it
    prepare_denoise(*picture.denoiser, picture.region.width(), picture.region.height(),
                    {.prefilter = options.denoise.prefilter}, true, picture.scale, picture.noisy_guides);
  });
}

double expect_finish_seconds(const RenderContext& context) {
  const PreparedPicture& picture = context.picture;
  const double seconds =
      picture.arena.execute([&] { return time_shadows(picture) + time_denoiser(picture); });
  return context.team.agreed(seconds);
}

std::optional<double> estimate_error(const RenderContext& context, Film& film) {
  context.team.gather(film);
  std::optional<double> error;
  if (context.team.finishes())
    error = error_of_picture(film, finishing(context.picture, 1.0, {}), context.picture.arena);
  return context.team.agreed(error);
}

}  // namespace gatelight::renderer

#include "renderer/run/finished_picture.h"

#include <algorithm>
#include <utility>

#include "renderer/machine/clock.h"
#include "renderer/metrics/estimated_error.h"
#include "renderer/reconstruction/reconstruct.h"
#include "renderer/run/background.h"
#include "renderer/settings/words.h"

namespace gatelight::renderer {
namespace {

/// The layers that reconstruction reads and nobody asked for.
void drop_unwanted(Picture& picture, const std::vector<Aov>& aovs) {
  if (std::find(aovs.begin(), aovs.end(), Aov::reconstruction) != aovs.end()) return;
  std::erase_if(picture.layers, [&](const Layer& layer) {
    return !layer.name.empty() && !layer.name.starts_with(kLightLayer) &&
           std::none_of(aovs.begin(), aovs.end(), [&](Aov aov) { return word(aov) == layer.name; });
  });
}

/// The samples' own brightness is taken from so many pixels around each, in each direction.
constexpr int kSmoothing = 5;
/// The same of finished halves, which have less noise.
constexpr int kHalfSmoothing = 1;
/// An error counts relative to at least this share of the finished value.
constexpr float kLeastShare = 0.2f;

/// Samples of a pixel that tell an error.
constexpr double kTellingSamples = 2.0;

std::optional<double> error_of(const Film& film, const Picture& picture) {
  if (film.samples_per_pixel() < kTellingSamples) return std::nullopt;
  return estimated_error(picture, picture.layers.front(), film.layer(Aov::error), kSmoothing);
}

/// The halves are as good as independent, so half their difference is the error of their mean. Relative to
/// the darker one: where one half met a bright sample, the other one tells what is usual there. The finished
/// picture is the front layer.
double error_of(const Picture& picture, const Reconstruction& finished) {
  const auto& [a, b] = finished.halves;
  const std::vector<float>& color = picture.layers.front().values;
  Layer darker{.channels = picture.layers.front().channels, .values = a}, errors = darker;
  for (std::size_t i = 0; i < a.size(); ++i) {
    darker.values[i] = std::max(std::min(a[i], b[i]), kLeastShare * color[i]);
    errors.values[i] = 0.5f * (a[i] - b[i]);
  }
  return estimated_error(picture, darker, errors, kHalfSmoothing);
}

SampledPicture samples_of(const Picture& picture, const RenderOptions& options) {
  SampledPicture samples = sampled_picture(picture);
  // Occlusion does not depend on what a surface reflects.
  if (options.integrator == Integrator::ao || options.integrator == Integrator::nao)
    std::fill(samples.albedo.begin(), samples.albedo.end(), 1.0f);
  return samples;
}

/// Both halves get the same.
void improve(SampledPicture& samples, const PixelRect& rect, const SharedRows& rows,
             const SeenLight& better) {
  std::vector<float>&a = samples.halves[0].seen, &b = samples.halves[1].seen;
  if (a.empty()) return;
  std::vector<float> seen(a.size());
  for (std::size_t i = 0; i < seen.size(); ++i)
    seen[i] = samples.counts[i / 3] < 2.0f ? a[i] : 0.5f * (a[i] + b[i]);
  const std::vector<float> before = seen;
  better(rect, rows, seen);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] != before[i]) a[i] = b[i] = seen[i];
  }
}

/// A value for each pixel of the rows. Panes that stochastic rays pass are as noisy in it as in the colours,
/// and it is finished in the same way. `samples`: those of the colours, where the picture is reconstructed.
std::vector<float> finished_alpha(const Film& film, const SharedRows& rows, SampledPicture* samples,
                                  const CaughtShadows& shadows) {
  if (!samples) {
    std::vector<float> alpha = film.layer(Aov::alpha).values;
    for (std::size_t h = 0; shadows && h < 2; ++h) {
      const std::vector<float> caught = shadows(film.rect(), h);
      for (std::size_t p = 0; p < alpha.size(); ++p) alpha[p] += 0.5f * caught[p];
    }
    return alpha;
  }
  for (std::size_t h = 0; h < 2; ++h) {
    SampledPicture::Half& half = samples->halves[h];
    std::vector<float> alpha = film.alpha_of_half(h);
    if (shadows) {
      const std::vector<float> caught = shadows(film.rect(), h);
      for (std::size_t p = 0; p < alpha.size(); ++p) alpha[p] += caught[p];
    }
    for (std::size_t i = 0; i < half.color.size(); ++i) {
      const float a = std::clamp(alpha[i / 3], 0.0f, 1.0f);
      half.color[i] = a;
      // The variance of a share.
      half.variance[i] = a * (1.0f - a) / std::max(0.5f * samples->counts[i / 3], 1.0f);
    }
    half.cache.clear();
    half.seen.clear();
  }
  std::fill(samples->albedo.begin(), samples->albedo.end(), 1.0f);
  const std::vector<float> color = reconstruct_rows(*samples, rows).color;
  std::vector<float> result(color.size() / 3);
  for (std::size_t p = 0; p < result.size(); ++p) result[p] = color[3 * p];
  return result;
}

/// Leaves the rows of the picture that are finished.
void crop(Picture& picture, const SharedRows& rows) {
  if (picture.height == rows.end - rows.first) return;
  const auto width = static_cast<std::ptrdiff_t>(picture.width);
  const std::ptrdiff_t above = (rows.first - rows.top) * width, pixels = (rows.end - rows.first) * width;
  for (Layer& layer : picture.layers) {
    const auto channels = static_cast<std::ptrdiff_t>(layer.channels.size());
    const auto begin = layer.values.begin() + above * channels;
    layer.values = std::vector<float>(begin, begin + pixels * channels);
  }
  picture.y0 += rows.first - rows.top;
  picture.height = rows.end - rows.first;
}

}  // namespace

Reconstruction finished_film(const Film& film, const SharedRows& rows, const RenderOptions& options) {
  return reconstruct_rows(samples_of(film.resolve(), options), rows);
}

FinishedPicture finished_rows(const Film& film, const SharedRows& rows, const RenderOptions& options,
                              tbb::task_arena& arena, const SeenLight& better, const CaughtShadows& shadows) {
  FinishedPicture result;
  Picture& picture = result.picture;
  arena.execute([&] {
    picture = film.resolve();
    SampledPicture samples = samples_of(picture, options);
    if (better) improve(samples, film.rect(), rows, better);
    drop_unwanted(picture, options.aovs);
    crop(picture, rows);
    Reconstruction& finished = result.reconstruction = reconstruct_rows(samples, rows);
    picture.layers.front().values = std::move(finished.color);
    for (Layer& layer : picture.layers) {
      if (layer.name == word(Aov::error)) layer.values = std::move(finished.error);
    }
    if (options.background.apart()) result.alpha = finished_alpha(film, rows, &samples, shadows);
  });
  return result;
}

void complete(FinishedPicture& whole, double samples_per_pixel, const RenderOptions& options) {
  whole.lost_light = lost_light(whole.reconstruction.kept_and_lost);
  if (samples_per_pixel >= kTellingSamples)
    whole.estimated_error = error_of(whole.picture, whole.reconstruction);
  if (options.background.apart()) put_before(whole.picture, whole.alpha, options.background);
}

FinishedPicture finished_picture(const Film& film, const RenderOptions& options, tbb::task_arena& arena,
                                 const SeenLight& better, const CaughtShadows& shadows) {
  const Clock::time_point start = Clock::now();
  const SharedRows all = SharedRows::all(film.rect().height());
  FinishedPicture result;
  if (options.reconstruct) {
    result = finished_rows(film, all, options, arena, better, shadows);
    arena.execute([&] { complete(result, film.samples_per_pixel(), options); });
    result.reconstruct_seconds = seconds_since(start);
    return result;
  }
  arena.execute([&] {
    result.picture = film.resolve();
    result.estimated_error = error_of(film, result.picture);
    drop_unwanted(result.picture, options.aovs);
    if (options.background.apart())
      put_before(result.picture, finished_alpha(film, all, nullptr, shadows), options.background);
  });
  return result;
}

std::optional<double> error_of_samples(const Film& film, tbb::task_arena& arena) {
  return arena.execute([&] { return error_of(film, film.resolve()); });
}

}  // namespace gatelight::renderer

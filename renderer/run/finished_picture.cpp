#include "renderer/run/finished_picture.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "renderer/machine/clock.h"
#include "renderer/metrics/estimated_error.h"
#include "renderer/reconstruction/reconstruct.h"
#include "renderer/run/background.h"
#include "renderer/settings/words.h"

namespace gatelight::renderer {
namespace {

/// Not a layer that reconstruction reads and nobody asked for.
bool is_wanted(const Layer& layer, const std::vector<Aov>& aovs) {
  return has(aovs, Aov::reconstruction) || layer.name.empty() || layer.name.starts_with(kLightLayer) ||
         std::any_of(aovs.begin(), aovs.end(), [&](Aov aov) { return word(aov) == layer.name; });
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

SampledPicture samples_of(Picture& picture, const RenderOptions& options) {
  SampledPicture samples = take_samples(picture);
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

PixelRect rect_of(const Picture& picture) {
  return {picture.x0, picture.y0, picture.x0 + picture.width, picture.y0 + picture.height};
}

/// The mean alpha of each half, with the shadows that it caught.
std::array<std::vector<float>, 2> alpha_of_halves(const Picture& picture, const CaughtShadows& shadows) {
  std::array<std::vector<float>, 2> alphas = {picture.find("alpha-a")->values,
                                              picture.find("alpha-b")->values};
  for (std::size_t h = 0; shadows && h < 2; ++h) {
    const std::vector<float> caught = shadows(rect_of(picture), h);
    for (std::size_t p = 0; p < caught.size(); ++p) alphas[h][p] += caught[p];
  }
  return alphas;
}

/// The same of all samples.
std::vector<float> mean_alpha(const Picture& picture, const CaughtShadows& shadows) {
  std::vector<float> alpha = picture.find("alpha")->values;
  for (std::size_t h = 0; shadows && h < 2; ++h) {
    const std::vector<float> caught = shadows(rect_of(picture), h);
    for (std::size_t p = 0; p < caught.size(); ++p) alpha[p] += 0.5f * caught[p];
  }
  return alpha;
}

/// Alpha takes the place of the colours. Panes that stochastic rays pass are as noisy in it, and it is
/// finished in the same way.
void replace_by_alpha(SampledPicture& samples, const std::array<std::vector<float>, 2>& alphas) {
  for (const std::size_t h : {0u, 1u}) {
    SampledPicture::Half& half = samples.halves[h];
    for (std::size_t i = 0; i < half.color.size(); ++i) {
      const float a = std::clamp(alphas[h][i / 3], 0.0f, 1.0f);
      half.color[i] = a;
      // The variance of a share.
      half.variance[i] = a * (1.0f - a) / std::max(0.5f * samples.counts[i / 3], 1.0f);
    }
    half.cache.clear();
    half.seen.clear();
  }
  std::fill(samples.albedo.begin(), samples.albedo.end(), 1.0f);
}

/// The first of three channels, which are equal.
std::vector<float> first_channel(const std::vector<float>& color) {
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

Reconstruction reconstruction_of(Picture picture, const SharedRows& rows, const RenderOptions& options) {
  return reconstruct_rows(samples_of(picture, options), rows);
}

FinishedPicture finished_rows(Picture picture, const SharedRows& rows, const RenderOptions& options,
                              const SeenLight& better, const CaughtShadows& shadows) {
  std::array<std::vector<float>, 2> alphas;
  if (options.background.apart()) alphas = alpha_of_halves(picture, shadows);
  std::vector<Layer> wanted;
  std::copy_if(picture.layers.begin(), picture.layers.end(), std::back_inserter(wanted),
               [&](const Layer& layer) { return is_wanted(layer, options.aovs); });
  SampledPicture samples = samples_of(picture, options);
  if (better) improve(samples, rect_of(picture), rows, better);
  picture.layers = std::move(wanted);
  crop(picture, rows);

  FinishedPicture result;
  Reconstruction& finished = result.reconstruction = reconstruct_rows(samples, rows);
  picture.layers.front().values = std::move(finished.color);
  for (Layer& layer : picture.layers) {
    if (layer.name == word(Aov::error)) layer.values = std::move(finished.error);
  }
  result.picture = std::move(picture);
  if (options.background.apart()) {
    replace_by_alpha(samples, alphas);
    result.alpha = first_channel(reconstruct_rows(samples, rows).color);
  }
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
  FinishedPicture result;
  arena.execute([&] {
    Picture picture = film.resolve();
    if (options.reconstruct) {
      result =
          finished_rows(std::move(picture), SharedRows::all(film.rect().height()), options, better, shadows);
      complete(result, film.samples_per_pixel(), options);
      return;
    }
    result.estimated_error = error_of(film, picture);
    std::vector<float> alpha;
    if (options.background.apart()) alpha = mean_alpha(picture, shadows);
    std::erase_if(picture.layers, [&](const Layer& layer) { return !is_wanted(layer, options.aovs); });
    if (options.background.apart()) put_before(picture, alpha, options.background);
    result.picture = std::move(picture);
  });
  if (options.reconstruct) result.reconstruct_seconds = seconds_since(start);
  return result;
}

std::optional<double> error_of_samples(const Film& film, tbb::task_arena& arena) {
  return arena.execute([&] { return error_of(film, film.resolve()); });
}

}  // namespace gatelight::renderer

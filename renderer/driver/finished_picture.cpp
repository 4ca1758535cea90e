#include "renderer/driver/finished_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/clock.h"
#include "renderer/denoise/denoising_layers.h"
#include "renderer/driver/background.h"
#include "renderer/metrics/estimated_error.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::renderer {
namespace {

/// Number of pixels around each, in each direction, whose mean is the brightness in the relative error.
constexpr int kSmoothing = 5;
/// Least number of samples per pixel for an estimate of the error.
constexpr double kSamplesForError = 2.0;
/// The error is estimated from strips of this many rows of the film. The strips have this many pixels or this
/// share of all, whichever is more.
constexpr int kStripRows = 128;
constexpr double kStripPixels = 1 << 17;
constexpr double kStripShare = 0.25;
constexpr int kStripMargin = 16;
/// The picture's share of the denoiser's time; the estimate of the error has the rest.
constexpr double kShareOfPicture = 0.85;

PixelRect picture_rect(const Film& film, const ScaleDown& scale) {
  const PixelRect& r = film.rect();
  const int f = scale.factor();
  return {r.x0 / f, r.y0 / f, r.x1 / f, r.y1 / f};
}

/// The samples with their guides. Rows count from the top of the film.
NoisyPicture noisy(const Film& film, const Finishing& f, Plane color) {
  const auto rows = [&film](Plane plane) -> ReadRows {
    return [&film, plane](int first, int end) {
      return film.plane(plane, film.rect().y0 + first, film.rect().y0 + end);
    };
  };
  NoisyPicture picture{.width = film.rect().width(),
                       .height = film.rect().height(),
                       .color = rows(color),
                       .albedo = rows(Plane::albedo),
                       .normal = rows(Plane::normal),
                       .noisy_guides = f.noisy_guides};
  // Occlusion does not depend on the reflectance of a surface.
  if (f.options.integrator == Integrator::ao || f.options.integrator == Integrator::nao) {
    picture.albedo = [&film](int first, int end) {
      return std::vector<float>(
          3 * static_cast<std::size_t>(end - first) * static_cast<std::size_t>(film.rect().width()), 1.0f);
    };
  }
  return picture;
}

/// The filter's options for an estimate of the error: fast, and with the guides as they are.
FilterOptions error_options(const Film& film) {
  return {.prefilter = Prefilter::fast,
          .quality = DenoiseQuality::fast,
          .scale = exposure_of(film.rect().width(), film.rect().height(), [&film](int first, int end) {
            return film.plane(Plane::mean, film.rect().y0 + first, film.rect().y0 + end);
          })};
}

/// The halves of the samples have independent noise, and the filter's own error is about as large. So the
/// error of the whole is about the root of half the mean square of their difference (denoise/README.md).
struct DenoisedHalves {
  std::vector<float> mean;
  std::vector<float> error;
};
std::optional<DenoisedHalves> denoised_halves(const Film& film, const Finishing& f,
                                              const FilterOptions& filter, const RowsToDenoise& rows,
                                              const DenoiseProgress& progress) {
  std::array<std::vector<float>, 2> halves;
  for (const std::size_t h : {0u, 1u}) {
    const Plane plane = h == 0 ? Plane::half_a : Plane::half_b;
    const auto report = [&](double done) { return !progress || progress(0.5 * (h + done)); };
    auto denoised = denoise_rows(*f.denoiser, noisy(film, f, plane), rows, filter, f.scale, report);
    if (!denoised) return std::nullopt;
    halves[h] = std::move(denoised->color);
  }
  DenoisedHalves result{halves[0], halves[1]};
  for (std::size_t i = 0; i < result.mean.size(); ++i) {
    const float a = halves[0][i], b = halves[1][i];
    result.mean[i] = 0.5f * (a + b);
    result.error[i] = std::sqrt(0.5f) * std::abs(a - b);
  }
  return result;
}

/// The relative RMS error of some finished rows.
double error_of(DenoisedHalves halves, int width, int rows) {
  const Picture picture{.width = width, .height = rows};
  const Layer mean{.channels = {"R", "G", "B"}, .values = std::move(halves.mean)};
  const Layer error{.channels = {"R", "G", "B"}, .values = std::move(halves.error)};
  return estimated_error(picture, mean, error, 0);
}

std::optional<double> denoised_error(const Film& film, const Finishing& f,
                                     const DenoiseProgress& progress = {}) {
  const PixelRect rect = picture_rect(film, f.scale);
  const double all = static_cast<double>(film.pixels());
  const double share = std::min(1.0, std::max(kStripShare, kStripPixels / all));
  const int rows = rect.height(), strip = std::max(kStripRows / f.scale.factor(), 1);
  const int strips = std::max(1, static_cast<int>(std::ceil(share * rows / strip)));
  const FilterOptions filter = error_options(film);
  double squares = 0.0, weight = 0.0;
  for (int s = 0; s < strips; ++s) {
    // Evenly spread; adjacent where they cover the whole film.
    const int cell_begin = s * rows / strips, cell_end = (s + 1) * rows / strips;
    const int height = std::min(strip, cell_end - cell_begin);
    const int begin = cell_begin + (cell_end - cell_begin - height) / 2;
    const auto report = [&](double done) { return !progress || progress((s + done) / strips); };
    auto halves = denoised_halves(film, f, filter, {begin, begin + height, kStripMargin}, report);
    if (!halves) return std::nullopt;
    const double error = error_of(std::move(*halves), rect.width(), height);
    squares += error * error * height;
    weight += height;
  }
  return std::sqrt(squares / weight);
}

/// The error of the samples' means, by their variance.
std::optional<double> sampled_error(const Film& film) {
  const PixelRect& rect = film.rect();
  const Picture size{.width = rect.width(), .height = rect.height()};
  const Layer mean{.channels = {"R", "G", "B"}, .values = film.plane(Plane::mean, rect.y0, rect.y1)};
  return estimated_error(size, mean, film.layer(Aov::error), kSmoothing);
}

/// A layer of the film's size, in that of the picture.
void scale_layer(Layer& layer, const Film& film, const ScaleDown& scale) {
  if (scale.factor() == 1) return;
  const int f = scale.factor(), width = film.rect().width(), height = film.rect().height();
  const auto channels = static_cast<int>(layer.channels.size());
  const AovInfo* const aov = find_aov(layer.name);
  const AovScaling scaling = aov ? aov->scaling : AovScaling::mean;
  if (scaling != AovScaling::first) {
    layer.values = scale.scale(layer.values, channels, width, height, 0, 0, height / f);
    const auto times = static_cast<float>(f * f);
    if (scaling == AovScaling::sum)
      for (float& value : layer.values) value *= times;
    if (scaling == AovScaling::mean_variance)
      for (float& value : layer.values) value /= times;
    return;
  }
  std::vector<float> values;
  for (int y = 0; y < height; y += f) {
    for (int x = 0; x < width; x += f) {
      const auto at =
          (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
          static_cast<std::size_t>(channels);
      values.insert(values.end(), &layer.values[at], &layer.values[at] + channels);
    }
  }
  layer.values = std::move(values);
}

std::vector<float> rows_of_alpha(const Film& film, const std::vector<float>& shadows, int first, int end) {
  std::vector<float> alpha = film.plane(Plane::alpha, film.rect().y0 + first, film.rect().y0 + end);
  const std::size_t from = static_cast<std::size_t>(first) * static_cast<std::size_t>(film.rect().width());
  for (std::size_t i = 0; i < alpha.size() && !shadows.empty(); ++i) alpha[i] += shadows[from + i];
  return alpha;
}

class Finisher {
 public:
  Finisher(const Film& film, const Finishing& finishing)
      : film_(film), f_(finishing), options_(finishing.options) {
    if (options_.background.is_separate() && f_.shadows) shadows_ = f_.shadows(film.rect());
  }

  FinishedPicture as_traced() {
    FinishedPicture result{.picture = layers()};
    if (estimates_error()) result.estimated_error = sampled_error(film_);
    const int width = film_.rect().width(), height = film_.rect().height();
    finish(result.picture, [&] {
      return f_.scale.scale(rows_of_alpha(film_, shadows_, 0, height), 1, width, height, 0, 0,
                            height / f_.scale.factor());
    });
    return result;
  }

  /// Empty where it is cancelled.
  std::optional<FinishedPicture> denoised() {
    auto denoised = denoise(*f_.denoiser, samples(), {.prefilter = options_.denoise.prefilter}, f_.scale,
                            part(0.0, kShareOfPicture));
    if (!denoised) return std::nullopt;
    if (f_.after_denoising) f_.after_denoising(*denoised);
    FinishedPicture result{.picture = layers(), .denoised = true};
    result.picture.layers.front().values = std::move(denoised->color);
    if (options_.denoise.parts && !denoise_parts(result.picture)) return std::nullopt;
    if (estimates_error()) {
      Layer* const error = find(result.picture, Aov::error);
      if (!(error ? report_errors(result, error->values) : report_error(result))) return std::nullopt;
    }
    finish(result.picture, [&] { return std::move(denoised->alpha); });
    return result;
  }

 private:
  static Layer* find(Picture& picture, Aov aov) {
    for (Layer& layer : picture.layers) {
      if (layer.name == enum_name(aov)) return &layer;
    }
    return nullptr;
  }

  /// Whether the film's samples are all of the picture.
  bool estimates_error() const {
    return film_.samples_per_pixel() >= kSamplesForError && !f_.after_denoising;
  }

  /// The samples, with an alpha where the background is separate.
  NoisyPicture samples() const {
    NoisyPicture picture = noisy(film_, f_, Plane::mean);
    if (options_.background.is_separate())
      picture.alpha = [this](int first, int end) { return rows_of_alpha(film_, shadows_, first, end); };
    return picture;
  }

  DenoiseProgress part(double begin, double end) const {
    return
        [this, begin, end](double done) { return !f_.progress || f_.progress(std::lerp(begin, end, done)); };
  }

  /// All layers that are not denoised.
  Picture layers() const {
    Picture picture = film_.resolve();
    for (Layer& layer : picture.layers) scale_layer(layer, film_, f_.scale);
    const PixelRect rect = picture_rect(film_, f_.scale);
    picture.width = rect.width();
    picture.height = rect.height();
    picture.x0 = rect.x0;
    picture.y0 = rect.y0;
    picture.full_width /= f_.scale.factor();
    picture.full_height /= f_.scale.factor();
    return picture;
  }

  /// Denoises the layers of the parts of the light, each with the picture's guides.
  bool denoise_parts(Picture& picture) const {
    std::vector<Layer*> groups, passes;
    for (std::size_t number = 0; number < film_.parts().size(); ++number) {
      const std::string& name = film_.parts()[number];
      Layer& layer = *std::find_if(picture.layers.begin(), picture.layers.end(),
                                   [&](const Layer& l) { return l.name == name; });
      (find_aov(name) ? passes : groups).push_back(&layer);
      if (std::all_of(layer.values.begin(), layer.values.end(), [](float value) { return value == 0.0f; }))
        continue;
      NoisyPicture light = noisy(film_, f_, Plane::mean);
      light.color = [this, number](int first, int end) {
        return film_.part(number, film_.rect().y0 + first, film_.rect().y0 + end);
      };
      auto denoised = denoise(*f_.denoiser, light, {.prefilter = options_.denoise.prefilter}, f_.scale,
                              part(kShareOfPicture, kShareOfPicture));
      if (!denoised) return false;
      layer.values = std::move(denoised->color);
    }
    scale_to(picture.layers.front(), groups);
    if (passes.size() == all_passes().size()) scale_to(picture.layers.front(), passes);
    return true;
  }

  /// Scales the parts so that their sum is the whole. Light that no part has goes to the first.
  static void scale_to(const Layer& whole, const std::vector<Layer*>& parts) {
    for (std::size_t i = 0; i < whole.values.size() && !parts.empty(); ++i) {
      double sum = 0.0;
      for (const Layer* part : parts) sum += static_cast<double>(part->values[i]);
      const double scale = sum > 0.0 ? static_cast<double>(whole.values[i]) / sum : 0.0;
      for (Layer* part : parts)
        part->values[i] = static_cast<float>(scale * static_cast<double>(part->values[i]));
      if (!(sum > 0.0)) parts.front()->values[i] = whole.values[i];
    }
  }

  bool report_error(FinishedPicture& result) const {
    result.estimated_error = denoised_error(film_, f_, part(kShareOfPicture, 1.0));
    return result.estimated_error.has_value();
  }

  /// Estimates the error of each pixel too.
  bool report_errors(FinishedPicture& result, std::vector<float>& errors) const {
    const int height = result.picture.height;
    const int step = rows_of_band(film_.rect().width(), film_.rect().height(), f_.scale);
    const FilterOptions filter = error_options(film_);
    DenoisedHalves all;
    for (int begin = 0; begin < height; begin += step) {
      const int end = std::min(begin + step, height);
      const auto at = [&](int row) {
        return std::lerp(kShareOfPicture, 1.0, static_cast<double>(row) / height);
      };
      const auto halves = denoised_halves(film_, f_, filter, {begin, end}, part(at(begin), at(end)));
      if (!halves) return false;
      all.mean.insert(all.mean.end(), halves->mean.begin(), halves->mean.end());
      all.error.insert(all.error.end(), halves->error.begin(), halves->error.end());
    }
    errors = all.error;
    result.estimated_error = error_of(std::move(all), result.picture.width, height);
    return true;
  }

  /// Adds the parts that do not depend on how the colours were found.
  template <class Alpha>
  void finish(Picture& picture, const Alpha& alpha) const {
    picture.layers.insert(picture.layers.end(), f_.motion.begin(), f_.motion.end());
    if (has(options_.aovs, Aov::denoising)) add_denoising_layers(picture, samples(), f_.scale.factor());
    if (options_.background.is_separate()) put_before(picture, alpha(), options_.background);
  }

  const Film& film_;
  const Finishing& f_;
  const RenderOptions& options_;
  std::vector<float> shadows_;  ///< alpha of caught shadows; empty: none
};

}  // namespace

FinishedPicture finished_picture(const Film& film, const Finishing& finishing, tbb::task_arena& arena) {
  const Clock::time_point start = Clock::now();
  FinishedPicture result;
  arena.execute([&] {
    Finisher finisher(film, finishing);
    if (finishing.denoiser) {
      std::optional<FinishedPicture> denoised;
      result.failure = failure_to_denoise([&] { denoised = finisher.denoised(); });
      if (denoised) {
        result = std::move(*denoised);
        return;
      }
      result.stopped = result.failure.empty();
      if (result.stopped) result.failure = "denoising was stopped";
    }
    FinishedPicture traced = finisher.as_traced();
    traced.stopped = result.stopped;
    traced.failure = std::move(result.failure);
    result = std::move(traced);
  });
  if (finishing.denoiser) result.denoise_seconds = seconds_since(start);
  return result;
}

std::optional<double> error_of_picture(const Film& film, const Finishing& finishing, tbb::task_arena& arena) {
  if (film.samples_per_pixel() < kSamplesForError) return std::nullopt;
  return arena.execute([&]() -> std::optional<double> {
    if (!finishing.denoiser) return sampled_error(film);
    std::optional<double> error;
    failure_to_denoise([&] { error = denoised_error(film, finishing); });  // finished_picture() reports it
    return error;
  });
}

}  // namespace gatelight::renderer

#include "renderer/denoise/denoise.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/parallel/loops.h"

namespace gatelight::renderer {
namespace {

/// The networks halve images several times, so the result of a row depends on its place in blocks of this
/// many rows.
constexpr int kAlignment = 64;
/// Pixels of a band, with its margins, before they are scaled: some 72 bytes each.
constexpr std::int64_t kBandPixels = std::int64_t{1} << 22;

}  // namespace

int rows_of_band(int width, int height, const ScaleDown& scale) {
  constexpr int kMargin = RowsToDenoise().margin;
  const std::int64_t rows = kBandPixels / width;
  if (height <= rows) return height / scale.factor();
  // At least as many rows as the margins have.
  return static_cast<int>(std::max<std::int64_t>(rows - 2 * (kMargin + scale.reach()), 2 * kMargin)) /
         scale.factor();
}

void prepare_denoise(Denoiser& denoiser, int width, int height, const FilterOptions& options, bool guides,
                     const ScaleDown& scale, const std::optional<PixelRect>& noisy_guides) {
  if (rows_of_band(width, height, scale) * scale.factor() >= height)
    denoiser.prepare(width, height, options, guides, noisy_guides);
}

std::optional<DenoisedRows> denoise_rows(Denoiser& denoiser, const NoisyPicture& picture,
                                         const RowsToDenoise& rows, const FilterOptions& options,
                                         const ScaleDown& scale, const DenoiseProgress& progress) {
  const int margin = rows.margin + scale.reach();
  const int top = std::max(rows.begin * scale.factor() - margin, 0) / kAlignment * kAlignment;
  const int bottom = std::min(rows.end * scale.factor() + margin, picture.height);
  NoisyImage image{.width = picture.width, .height = bottom - top};
  if (picture.noisy_guides) {
    const auto& [x0, y0, x1, y1] = *picture.noisy_guides;
    image.noisy_guides = {x0, std::max(y0, top) - top, x1, std::min(y1, bottom) - top};
  }
  const bool guides = picture.albedo && picture.normal;
  const std::pair<const ReadRows*, std::vector<float>*> planes[] = {
      {&picture.color, &image.color},
      {guides ? &picture.albedo : nullptr, &image.albedo},
      {guides ? &picture.normal : nullptr, &image.normal},
      {picture.alpha ? &picture.alpha : nullptr, &image.alpha}};
  // At the same time, because one thread touches the memory of each.
  for_each(std::size(planes), [&](std::size_t i) {
    const auto& [read, plane] = planes[i];
    if (read != nullptr) *plane = (*read)(top, bottom);
  });
  // The filter would give black a little light.
  const bool black = std::all_of(image.color.begin(), image.color.end(), [](float c) { return c == 0.0f; });
  if (!black && !denoiser.filter(image, options, progress)) return std::nullopt;
  for_each_range(image.color.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      image.color[i] = std::isfinite(image.color[i]) ? std::max(image.color[i], 0.0f) : 0.0f;
  });
  const bool whole = scale.factor() == 1 && rows.begin == top && rows.end == bottom;
  const auto scaled = [&](std::vector<float>& values, int channels) {
    if (whole || values.empty()) return std::move(values);
    return scale.scale(values, channels, picture.width, picture.height, top, rows.begin, rows.end);
  };
  return DenoisedRows{scaled(image.color, 3), scaled(image.alpha, 1)};
}

std::optional<DenoisedRows> denoise(Denoiser& denoiser, const NoisyPicture& picture, FilterOptions options,
                                    const ScaleDown& scale, const DenoiseProgress& progress) {
  options.scale = exposure_of(picture.width, picture.height, picture.color);
  prepare_denoise(denoiser, picture.width, picture.height, options, picture.albedo && picture.normal, scale,
                  picture.noisy_guides);
  const int rows = picture.height / scale.factor();
  const int step = rows_of_band(picture.width, picture.height, scale);
  if (step >= rows) return denoise_rows(denoiser, picture, {0, rows}, options, scale, progress);
  DenoisedRows all;
  for (int begin = 0; begin < rows; begin += step) {
    const int end = std::min(begin + step, rows);
    const auto report = [&](double done) {
      return !progress ||
             progress(std::lerp(static_cast<double>(begin), static_cast<double>(end), done) / rows);
    };
    const auto band = denoise_rows(denoiser, picture, {begin, end}, options, scale, report);
    if (!band) return std::nullopt;
    all.color.insert(all.color.end(), band->color.begin(), band->color.end());
    all.alpha.insert(all.alpha.end(), band->alpha.begin(), band->alpha.end());
  }
  return all;
}

}  // namespace gatelight::renderer

#include "renderer/denoise/exposure.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/math.h"
#include "base/parallel/loops.h"

namespace gatelight::renderer {
namespace {

constexpr int kBin = 16;

/// The mean luminance of each bin of some rows.
std::vector<double> means_of_bins(const std::vector<float>& color, int width, int height) {
  std::vector<double> means;
  for (int top = 0; top < height; top += kBin) {
    for (int left = 0; left < width; left += kBin) {
      double sum = 0.0;
      int pixels = 0;
      for (int y = top; y < std::min(top + kBin, height); ++y) {
        for (int x = left; x < std::min(left + kBin, width); ++x, ++pixels) {
          const float* const c = &color[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                             static_cast<std::size_t>(x))];
          sum += static_cast<double>(luminance({c[0], c[1], c[2]}));
        }
      }
      means.push_back(sum / pixels);
    }
  }
  return means;
}

}  // namespace

float exposure_of(int width, int height, const ReadRows& color) {
  constexpr int kRows = 2 * kBin;
  constexpr double kKey = 0.18, kBlack = 1e-8;
  std::vector<std::vector<double>> parts(static_cast<std::size_t>((height + kRows - 1) / kRows));
  for_each(parts.size(), [&](std::size_t part) {
    const int top = static_cast<int>(part) * kRows, end = std::min(top + kRows, height);
    parts[part] = means_of_bins(color(top, end), width, end - top);
  });
  std::vector<double> means;
  for (const std::vector<double>& part : parts) means.insert(means.end(), part.begin(), part.end());
  // A picture that is dim everywhere is not black.
  const double all = std::accumulate(means.begin(), means.end(), 0.0) /
                     std::max<double>(1.0, static_cast<double>(means.size()));
  double logarithms = 0.0, bins = 0.0;
  for (const double mean : means) {
    if (!(mean > kBlack * std::min(all, 1.0)) || !std::isfinite(mean)) continue;
    logarithms += std::log2(mean);
    bins += 1.0;
  }
  if (bins == 0.0) return 1.0f;
  constexpr double kMax = 1e30;  // a float holds its inverse too
  return static_cast<float>(std::clamp(kKey / std::exp2(logarithms / bins), 1.0 / kMax, kMax));
}

}  // namespace gatelight::renderer

#include "renderer/reconstruction/reconstruct.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "neural/simd/isa.h"
#include "renderer/reconstruction/kernel_tables.h"
#include "renderer/reconstruction/region.h"

namespace gatelight::renderer {
namespace {

const ReconstructionKernels& choose_kernels(const std::string& isa) {
  using neural::simd::Isa;
  [[maybe_unused]] const Isa chosen = neural::simd::select_isa(neural::simd::parse_isa(isa));
#if defined(__x86_64__)
  if (chosen == Isa::avx512) return kAvx512Reconstruction;
  if (chosen == Isa::avx2) return kAvx2Reconstruction;
#endif
  return kScalarReconstruction;
}

/// The median of the pixels' brightest channels, of those that are not black. A mean would be that of a
/// single bright sample.
float usual_brightness(const SampledPicture& s) {
  constexpr std::size_t kMost = 1000000;
  const std::size_t pixels = s.counts.size(), step = pixels / kMost + 1;
  std::vector<float> values;
  for (std::size_t p = 0; p < pixels; p += step) {
    const float* const color = &s.halves[0].color[3 * p];
    const float value = std::max({color[0], color[1], color[2]});
    if (value > 0.0f) values.push_back(value);
  }
  if (values.empty()) return 1.0f;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Both halves weigh as their numbers of samples.
void add_seen(const SampledPicture& s, Reconstruction& result) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, result.color.size(), 65536),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        const float n = std::max(s.counts[i / 3], 2.0f), in_b = std::floor(0.5f * n);
                        const float a = s.halves[0].seen[i];
                        const float b = s.counts[i / 3] < 2.0f ? a : s.halves[1].seen[i];
                        result.color[i] += ((n - in_b) * a + in_b * b) / n;
                        result.halves[0][i] += a;
                        result.halves[1][i] += b;
                      }
                    });
}

}  // namespace

Reconstruction reconstruct(const SampledPicture& samples, const ReconstructionOptions& options) {
  const ReconstructionKernels& kernels = choose_kernels(options.isa);
  const float scale = usual_brightness(samples);
  const std::size_t row = 3 * static_cast<std::size_t>(samples.width);
  Reconstruction result;
  result.color.resize(row * static_cast<std::size_t>(samples.height));
  result.error.resize(result.color.size());
  for (std::vector<float>& half : result.halves) half.resize(result.color.size());
  for (std::vector<float>& half : result.noise) half.resize(result.color.size() / 3);
  Region::Light light;
  // Regions begin at multiples of the halo, so that windows and bands lie the same way in each.
  const int step = std::max(options.rows_at_once / kHalo, 1) * kHalo;
  for (int first = 0; first < samples.height; first += step) {
    const int end = std::min(first + step, samples.height);
    Region region(samples, std::max(first - kHalo, 0), std::min(end + kHalo, samples.height), scale);
    region.fit(kernels);
    region.join();
    tbb::parallel_for(first, end, [&](int y) {
      const std::size_t at = static_cast<std::size_t>(y) * row;
      region.write_row(y, {&result.color[at],
                           &result.error[at],
                           {&result.halves[0][at], &result.halves[1][at]},
                           {&result.noise[0][at / 3], &result.noise[1][at / 3]}});
    });
    for (int y = first; y < end; ++y) {
      const Region::Light of_row = region.light_of_row(y);
      light.kept += of_row.kept;
      light.lost += of_row.lost;
    }
  }
  if (!samples.halves[0].seen.empty()) add_seen(samples, result);
  result.lost_light = light.lost > 0.0 ? light.lost / (light.kept + light.lost) : 0.0;
  return result;
}

}  // namespace gatelight::renderer

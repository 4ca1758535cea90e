#include "renderer/reconstruction/reconstruct.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

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

/// The median of the picture's brightest channels, of those that are not black. A mean would be that of a
/// single bright sample.
float usual_brightness(const SampledPicture& s, const SharedRows& rows) {
  constexpr std::size_t kMost = 1000000;
  const auto width = static_cast<std::size_t>(s.width);
  const std::size_t step = width * static_cast<std::size_t>(rows.height) / kMost + 1;
  const auto pixel_at = [&](int row) { return width * static_cast<std::size_t>(row); };
  std::vector<double> values;
  std::size_t p = (pixel_at(rows.first) + step - 1) / step * step;
  for (; p < pixel_at(rows.end); p += step) {
    const float* const color = &s.halves[0].color[3 * (p - pixel_at(rows.top))];
    const float value = std::max({color[0], color[1], color[2]});
    if (value > 0.0f) values.push_back(static_cast<double>(value));
  }
  values = rows.join(std::move(values));
  if (values.empty()) return 1.0f;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<float>(*middle);
}

/// Both halves weigh as their numbers of samples. `offset`: of the result's first pixel in the samples.
void add_seen(const SampledPicture& s, std::size_t offset, Reconstruction& result) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, result.color.size(), 65536),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        const std::size_t from = 3 * offset + i;
                        const float n = std::max(s.counts[from / 3], 2.0f), in_b = std::floor(0.5f * n);
                        const float a = s.halves[0].seen[from];
                        const float b = s.counts[from / 3] < 2.0f ? a : s.halves[1].seen[from];
                        result.color[i] += ((n - in_b) * a + in_b * b) / n;
                        result.halves[0][i] += a;
                        result.halves[1][i] += b;
                      }
                    });
}

}  // namespace

double lost_light(const std::vector<std::array<double, 2>>& kept_and_lost) {
  double kept = 0.0, lost = 0.0;
  for (const auto& [row_kept, row_lost] : kept_and_lost) {
    kept += row_kept;
    lost += row_lost;
  }
  return lost > 0.0 ? lost / (kept + lost) : 0.0;
}

Reconstruction reconstruct(const SampledPicture& samples, const ReconstructionOptions& options) {
  return reconstruct_rows(samples, SharedRows::all(samples.height), options);
}

Reconstruction reconstruct_rows(const SampledPicture& samples, const SharedRows& rows,
                                const ReconstructionOptions& options) {
  static_assert(kRowMargin == kHalo && kHalo % kRowUnit == 0 && kRowUnit == window::kStride);
  const ReconstructionKernels& kernels = choose_kernels(options.isa);
  const float scale = usual_brightness(samples, rows);
  const std::size_t row = 3 * static_cast<std::size_t>(samples.width);
  Reconstruction result;
  const int height = rows.end - rows.first;
  result.color.resize(row * static_cast<std::size_t>(height));
  result.error.resize(result.color.size());
  for (std::vector<float>& half : result.halves) half.resize(result.color.size());
  for (std::vector<float>& half : result.noise) half.resize(result.color.size() / 3);
  // Regions begin at rows where windows do.
  const int step = std::max(options.rows_at_once / kHalo, 1) * kHalo;
  for (int first = rows.first; first < rows.end; first += step) {
    const int end = std::min(first + step, rows.end);
    Region region(samples, rows.top, std::max(first - kHalo, rows.top),
                  std::min(end + kHalo, rows.top + samples.height), scale);
    region.fit(kernels, first, end);
    region.join();
    tbb::parallel_for(first, end, [&](int y) {
      const std::size_t at = static_cast<std::size_t>(y - rows.first) * row;
      region.write_row(y, {&result.color[at],
                           &result.error[at],
                           {&result.halves[0][at], &result.halves[1][at]},
                           {&result.noise[0][at / 3], &result.noise[1][at / 3]}});
    });
    for (int y = first; y < end; ++y) result.kept_and_lost.push_back(region.light_of_row(y));
  }
  if (!samples.halves[0].seen.empty()) {
    const int above = rows.first - rows.top;
    add_seen(samples, static_cast<std::size_t>(above) * static_cast<std::size_t>(samples.width), result);
  }
  return result;
}

}  // namespace gatelight::renderer

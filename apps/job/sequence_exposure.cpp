#include "apps/job/sequence_exposure.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "renderer/image/auto_exposure.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::apps {
namespace {

/// The logarithm of a pixel is too dark by half its relative variance: few pixels with many samples.
constexpr double kPixels = 320.0;
constexpr int kSamples = 128;
/// From the median, in stops: so much does one frame that is nearly black, or far too bright, count.
constexpr double kFarthest = 2.0;

}  // namespace

renderer::RenderOptions measuring_options(renderer::RenderOptions options) {
  using renderer::Integrator;
  const double aspect = static_cast<double>(options.width) / options.height;
  options.height = std::max(static_cast<int>(std::lround(std::sqrt(kPixels / aspect))), 1);
  options.width = std::max(static_cast<int>(std::lround(aspect * options.height)), 1);
  options.region.reset();
  const bool light = options.integrator == Integrator::path || options.integrator == Integrator::nrc;
  renderer::use_integrator(options, light ? Integrator::path : Integrator::ao);
  options.spp = kSamples;
  options.seed = 0;
  options.time_limit_seconds = options.max_error = 0.0;
  options.denoise = {.denoiser = renderer::DenoiserKind::none};
  options.aovs.clear();
  options.cryptomattes.clear();
  options.cache = {};
  options.checkpoint = {};
  return options;
}

float common_exposure(std::vector<float> stops) {
  if (stops.empty()) return 0.0f;
  std::sort(stops.begin(), stops.end());
  const double median = 0.5 * (stops[(stops.size() - 1) / 2] + stops[stops.size() / 2]);
  double sum = 0.0;
  for (const double one : stops) sum += std::clamp(one, median - kFarthest, median + kFarthest);
  return static_cast<float>(std::round(10.0 * sum / static_cast<double>(stops.size())) / 10.0);
}

float sequence_exposure(renderer::Renderer& renderer, const std::vector<int>& frames,
                        const std::function<void(int frame)>& show, const renderer::Callbacks& callbacks) {
  std::vector<float> stops;
  for (const int frame : frames) {
    show(frame);
    const renderer::Picture picture = renderer.render(callbacks);
    if (picture.layers.empty()) continue;  // another process has it
    if (const std::optional<float> suitable = renderer::exposure_of_light(picture))
      stops.push_back(*suitable);
  }
  return common_exposure(std::move(stops));
}

}  // namespace gatelight::apps

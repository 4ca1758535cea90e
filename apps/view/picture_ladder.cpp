#include "apps/view/picture_ladder.h"

#include <algorithm>
#include <cmath>

namespace gatelight::apps {
namespace {

/// Steps of a new cache; a frame goes on with half of them.
constexpr int kStepsOfDraft = 64, kStepsOfPreview = 256;
constexpr int kSamplesOfPreview = 2, kSamplesOfRefined = 6;
/// A draft takes about this long, in seconds.
constexpr double kSlow = 0.1, kFast = 0.05;
constexpr double kMinDivisor = 1.5, kMaxDivisor = 8.0;
constexpr int kMinPixels = 32;

/// The layers by which the page tells what is under the pointer.
constexpr renderer::Aov kGuides[] = {renderer::Aov::albedo, renderer::Aov::normal, renderer::Aov::depth,
                                     renderer::Aov::position, renderer::Aov::instance_id};

int divided(int pixels, double divisor) {
  return std::max(std::min(pixels, kMinPixels), static_cast<int>(std::lround(pixels / divisor)));
}

}  // namespace

renderer::RenderOptions options_of_stage(Stage stage, const renderer::RenderOptions& final, bool new_light,
                                         double divisor) {
  renderer::RenderOptions options = final;
  for (const renderer::Aov aov : kGuides) {
    if (stage != Stage::draft &&
        std::find(options.aovs.begin(), options.aovs.end(), aov) == options.aovs.end())
      options.aovs.push_back(aov);
  }
  if (stage == Stage::final) return options;
  options.denoise.prefilter = renderer::Prefilter::fast;
  options.denoise.supersampling = 1;
  options.max_error = 0.0;
  options.time_limit_seconds = 0.0;
  options.spp = stage == Stage::refined ? kSamplesOfRefined : stage == Stage::preview ? kSamplesOfPreview : 1;
  options.cache.train_steps = stage != Stage::draft ? kStepsOfPreview : new_light ? kStepsOfDraft : 0;
  if (stage != Stage::draft) return options;
  options.aovs.clear();
  options.cryptomattes.clear();
  options.region.reset();
  options.width = divided(final.width, divisor);
  options.height = divided(final.height, divisor);
  return options;
}

double next_divisor(double divisor, double seconds) {
  if (seconds > kSlow) divisor *= 1.25;
  if (seconds < kFast) divisor /= 1.25;
  return std::clamp(divisor, kMinDivisor, kMaxDivisor);
}

}  // namespace gatelight::apps

#pragma once
// All that `gatelight render` can be told.

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/settings/file_names.h"
#include "apps/settings/values.h"
#include "apps/terminal/progress.h"
#include "renderer/image/image_write.h"
#include "renderer/settings/options.h"
#include "renderer/settings/presets.h"
#include "scene/gltf.h"

namespace gatelight::apps {

struct RenderSettings {
  std::string scene;
  std::vector<std::string> outputs;
  renderer::RenderOptions render;
  scene::LoadOptions load;
  renderer::ImageWriteOptions image;
  std::optional<std::array<float, 3>> eye;  ///< become render.camera.look_at in complete_settings()
  std::optional<std::array<float, 3>> target;
  std::optional<std::array<float, 3>> up;
  std::string config;  ///< file of --config, empty for none
  std::string stats;   ///< file, "-" for stdout, empty for none
  ProgressMode progress = ProgressMode::automatic;
  bool reproducible = false;
  bool quiet = false;
  bool verbose = false;
  bool all_aovs = false;                   ///< --aov all: those that the integrator has
  std::optional<double> checkpoint_every;  ///< seconds; becomes render.checkpoint.every_seconds
  std::optional<renderer::CachePreset> preset;
  std::set<std::string> given;        ///< flags on the command line or in --config, with their dashes
  std::set<std::string> cache_flags;  ///< that mean nothing without a cache
};

/// The words that stand for the enumerations, in help, parsing and recipes.
Choices<renderer::Integrator> integrator_choices();
Choices<renderer::SamplerKind> sampler_choices();
Choices<renderer::PixelFilter> filter_choices();
Choices<renderer::MisHeuristic> mis_choices();
Choices<renderer::DirectLight> direct_choices();
Choices<renderer::LightSelection> light_selection_choices();
Choices<renderer::NanPolicy> nan_choices();
Choices<renderer::Aov> aov_choices();
Choices<renderer::Tonemap> tonemap_choices();
Choices<ProgressMode> progress_choices();

/// Flags that mean nothing beside the other values: of another encoding, rule or integrator. Refused, and no
/// part of recipes.
std::set<std::string> cache_flags_without_effect(const renderer::RenderOptions& options);

constexpr bool shows_cache(renderer::Aov aov) {
  return aov >= renderer::Aov::cache_answer;
}

/// Checks what single flags cannot know (does the region lie in the picture?) and fills in what follows from
/// the flags: the view by hand, the number of threads. Throws UsageError.
void complete_settings(RenderSettings& settings);

/// The files that are read, each with its flag, for those who write further ones.
FileNames read_files(const RenderSettings& settings);

/// Before the long work: the inputs exist, the outputs can be written. Throws InputError,
/// renderer::OutputError or renderer::UnknownFormat.
void check_files(const RenderSettings& settings);

}  // namespace gatelight::apps

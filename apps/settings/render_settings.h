#pragma once
// All settings of `gatelight render`.

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/settings/frame_range.h"
#include "apps/terminal/progress.h"
#include "renderer/image/image_write.h"
#include "renderer/settings/options.h"
#include "renderer/settings/presets.h"
#include "scene/gltf.h"

namespace gatelight::apps {

struct RenderSettings {
  std::string scene;
  std::vector<std::string> outputs;
  renderer::RenderOptions render{.environment = {.automatic = true}};
  scene::LoadOptions load;
  FrameSettings frames;
  renderer::ImageWriteOptions image;
  /// In stops; none: auto_exposure() of the picture. complete_settings() makes image.exposure of it.
  std::optional<float> exposure = 0.0f;
  std::optional<std::array<float, 3>>
      eye;  ///< complete_settings() makes render.camera.look_at of these three
  std::optional<std::array<float, 3>> target;
  std::optional<std::array<float, 3>> up;
  std::string view_file;       ///< file of --view-file, empty for none
  std::string config;          ///< file of --config, empty for none
  std::string stats;           ///< file, "-" for stdout, empty for none
  bool skip_existing = false;  ///< pictures are left out whose files are there
  ProgressMode progress = ProgressMode::automatic;
  bool reproducible = false;
  bool quiet = false;
  bool verbose = false;
  std::optional<renderer::CachePreset> preset;
  std::set<std::string> given;  ///< names of the options on the command line or in --config
};

}  // namespace gatelight::apps

#pragma once
// The work of `denoise`: one picture, or frames of an animation.

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/terminal/progress.h"
#include "renderer/denoise/layers_to_denoise.h"
#include "renderer/image/image_write.h"
#include "renderer/settings/options.h"

namespace gatelight::apps {

struct DenoiseSettings {
  std::string input;  ///< with the place of a frame's number in its name: frames
  std::vector<std::string> outputs;
  std::optional<std::vector<int>> frames;  ///< empty: those that exist
  renderer::ImageWriteOptions image;
  std::optional<float> exposure;
  renderer::RenderOptions render;  ///< only the options of `denoise` are used
  renderer::LayerNames layers;
  ProgressMode progress = ProgressMode::automatic;
  bool quiet = false;
};

/// Denoises, writes and reports; returns the exit code. `given`: the flags that the picture's recipe does not
/// override. Throws what main() catches.
int denoise(const DenoiseSettings& settings, const std::set<std::string>& given);

/// The numbers of frames whose files exist, in their order.
std::vector<int> existing_frames(const std::string& name);

}  // namespace gatelight::apps

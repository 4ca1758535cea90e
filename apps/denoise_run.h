#pragma once
// The work of `denoise`: one picture, or frames of an animation.

#include <string>
#include <vector>

#include "apps/settings/render_settings.h"
#include "renderer/denoise/layers_to_denoise.h"

namespace gatelight::apps {

struct DenoiseSettings : RenderSettings {
  /// The scene is the picture, with the place of a frame's number in its name for frames: those of the range,
  /// else those that exist. The picture's recipe does not override what is given.
  DenoiseSettings() { exposure.reset(); }

  renderer::LayerNames layers;
};

/// Denoises, writes and reports; returns the exit code. Throws what main() catches.
int denoise(const DenoiseSettings& settings);

/// The numbers of frames whose files exist, in their order.
std::vector<int> existing_frames(const std::string& name);

}  // namespace gatelight::apps

#pragma once
// Presets of a picture with a cache.

#include <cstdint>

#include "renderer/settings/options.h"

namespace gatelight::renderer {

enum class CachePreset : std::uint8_t {
  bare,       ///< the cache's answers at the first wide hit, not denoised
  preview,    ///< a finished picture in seconds: denoised, with few samples, whose paths end once they have
              ///< spread out
  standard,   ///< the same with more samples
  final,      ///< the same with many more
  paper_nao,  ///< ambient occlusion as in the paper
  paper_nrc,  ///< radiance as in the paper, without emission and reflectance of the primary hit
};

/// Sets the values of the preset: integrator, samples, cache options and, for the presets of the paper, steps
/// and the size of the picture. Other options stay.
void apply_preset(CachePreset preset, RenderOptions& options);

/// The same for frames of an animation, which share the cache and samples: finished pictures have three
/// quarters of the samples, and `standard` does not prefilter the guides. Walls are watertight for all views.
void apply_preset_of_frames(CachePreset preset, RenderOptions& options);

}  // namespace gatelight::renderer

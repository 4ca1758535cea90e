#pragma once
// Presets of a picture with a cache.

#include <cstdint>

#include "renderer/settings/options.h"

namespace gatelight::renderer {

enum class CachePreset : std::uint8_t {
  bare,       ///< the cache's answers at the first wide hit, as they are
  preview,    ///< a finished picture in seconds: few samples that end where they have spread out, denoised
  standard,   ///< the same with some more samples
  final,      ///< the same with many
  paper_nao,  ///< ambient occlusion as in the paper
  paper_nrc,  ///< radiance as in the paper, without emission and reflectance of the primary hit
};

/// Sets the values of the preset: integrator, samples, cache options and, for the presets of the paper, steps
/// and the size of the picture. Other options stay.
void apply_preset(CachePreset preset, RenderOptions& options);

/// The same for frames of an animation, which share cache and light: finished pictures have three quarters of
/// the samples, and `standard` ones guides that are not denoised first.
void apply_preset_of_frames(CachePreset preset, RenderOptions& options);

}  // namespace gatelight::renderer

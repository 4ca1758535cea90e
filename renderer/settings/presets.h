#pragma once
// Named settings of a picture with a cache.

#include <cstdint>

#include "renderer/settings/options.h"

namespace gatelight::renderer {

enum class CachePreset : std::uint8_t {
  preview,    ///< an impression in seconds: query at the primary hit, few samples
  final,      ///< a picture: longer training, query after a gather
  paper_nao,  ///< ambient occlusion as in the paper
  paper_nrc,  ///< radiance as in the paper, without emission and reflectance of the primary hit
};

/// Sets what the preset says and leaves the rest: integrator, samples, steps, and for those of the paper the
/// size of the picture. README.md tells each value and why.
void apply_preset(CachePreset preset, RenderOptions& options);

}  // namespace gatelight::renderer

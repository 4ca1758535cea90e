#pragma once
// Measures the denoiser's time on this machine.

#include "renderer/denoise/denoiser.h"
#include "renderer/settings/denoise_options.h"

namespace gatelight::renderer {

/// The expected seconds for a film of this size, with the estimate of its error: a part of it, of noise, is
/// denoised and timed. Runs in the caller's arena.
double expect_denoise_seconds(Denoiser& denoiser, const DenoiseOptions& options, int width, int height);

}  // namespace gatelight::renderer

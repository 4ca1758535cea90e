#pragma once
// Whether the guides of a denoiser need denoising themselves.

#include "renderer/film/camera.h"
#include "renderer/image/pixel_rect.h"
#include "renderer/settings/options.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

/// The share of some thousand pixels, 0 to 1, in which albedo or normal differ between two paths through the
/// middle: behind a lens, in glass that reflects and refracts, at transparent textures. Anti-aliasing is not
/// such noise. Depends on nothing else, so that every run makes the same choice. Runs in the caller's arena.
double noisy_share_of_guides(const World& world, const Camera& camera, const PixelRect& region,
                             const RenderOptions& options);

/// With so many samples of a pixel, and up to this noisy share, Prefilter::none is as good as accurate
/// (denoise/README.md).
inline constexpr double kSamplesWithoutPrefilter = 32.0;
inline constexpr double kNoisyShareWithoutPrefilter = 0.03;

}  // namespace gatelight::renderer

#pragma once
// SSIM: how similar the structure of two pictures is, within a small window that moves over both.
// Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to Structural
// Similarity", IEEE Transactions on Image Processing 13 (4), 2004.

#include "renderer/image/tonemap.h"
#include "renderer/metrics/beauty.h"

namespace gatelight::renderer {

struct SsimOptions {
  // How radiance is converted for the screen, as for ldr_flip().
  float exposure = 0.0f;  ///< stops
  Tonemap tonemap = Tonemap::none;
};

/// The side of the window in pixels. The window is a Gaussian with a standard deviation of 1.5.
inline constexpr int kSsimWindow = 11;

/// The mean SSIM over all windows that lie within the picture, in [-1, 1]. The windows cover grey values of
/// the screen in [0, 1]: sRGB, not rounded to bytes, 0.299 R + 0.587 G + 0.114 B as in the authors' program.
/// The picture is not downsampled first. Symmetric; equal pictures give exactly 1. Gives the same bits for
/// any number of threads. Throws what require_comparable() throws, and InputError for pictures that are
/// smaller than the window or have values that are not finite.
double ssim(const NamedPicture& reference, const NamedPicture& test, const SsimOptions& options = {});

/// Whether a window fits into the picture.
inline bool has_ssim(const Picture& picture) {
  return picture.width >= kSsimWindow && picture.height >= kSsimWindow;
}

}  // namespace gatelight::renderer

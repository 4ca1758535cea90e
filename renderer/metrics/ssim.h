#pragma once
// SSIM: how alike the structure of two pictures is, seen through a small window that moves over both. Wang,
// Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to Structural Similarity", IEEE
// Transactions on Image Processing 13 (4), 2004.

#include "renderer/image/tonemap.h"
#include "renderer/metrics/beauty.h"

namespace gatelight::renderer {

struct SsimOptions {
  // How radiance is brought onto the screen, as for ldr_flip().
  float exposure = 0.0f;  ///< stops
  Tonemap tonemap = Tonemap::none;
};

/// Pixels of the window's side: a Gaussian with a standard deviation of 1.5.
inline constexpr int kSsimWindow = 11;

/// Mean over all windows that lie within the picture, in [-1, 1], of the grey that a screen is sent (sRGB,
/// not rounded to bytes; 0.299 R + 0.587 G + 0.114 B as the authors'), in a range of 1. The picture is not
/// made smaller first. Symmetric; equal pictures give exactly 1. The same bits for any number of threads.
/// Throws CompareError for pictures of different sizes, smaller than the window, without a beauty layer or
/// with values that are not finite.
double ssim(const NamedPicture& reference, const NamedPicture& test, const SsimOptions& options = {});

/// Whether a window fits in.
inline bool has_ssim(const Picture& picture) {
  return picture.width >= kSsimWindow && picture.height >= kSsimWindow;
}

}  // namespace gatelight::renderer

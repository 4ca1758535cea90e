#pragma once
// The kernel of reconstruction and the data that it reads, as plain data.

#include <cstddef>

namespace gatelight::renderer {

/// The shape of windows and patches, in pixels.
namespace window {
inline constexpr int kStride = 4;   ///< from one window's centre to the next, in both directions
inline constexpr int kRadius = 7;   ///< of a window
inline constexpr int kPatch = 2;    ///< radius of the patches whose differences are the weights
inline constexpr int kMargin = 12;  ///< pixels around the picture, a multiple of the stride
inline constexpr int kFirst = 1;    ///< the first centre, in pixels from the picture's corner
inline constexpr int kSide = 2 * kRadius + 1;
static_assert(kMargin % kStride == 0 && kMargin + kFirst >= kRadius + kPatch);
}  // namespace window

/// What colours are fitted to: normal and depth, and the light that a cache knows.
inline constexpr int kFewestGuides = 4, kMostGuides = 7;
inline constexpr int kEdges = 6;  ///< what tells surfaces apart: normal and divisor

/// One half of the samples.
struct HalfView {
  const float* color[3] = {};
  const float* variance = nullptr;  ///< of a pixel's mean: the sum of the channels, a little smoothed
};

/// What the windows of one half add up for each pixel.
struct FitView {
  float* color[3] = {};
  float* weight = nullptr;
  float* influence = nullptr;  ///< of the pixel's own samples on its value
};

/// Some rows of a picture as planes. The columns of a plane's row are dealt to window::kStride phases, so
/// that the same column of neighbouring windows is contiguous: column x lies at (x % kStride) * phase + x /
/// kStride.
struct BandView {
  int columns = 0;        ///< of windows
  std::size_t row = 0;    ///< floats from one row to the next
  std::size_t phase = 0;  ///< floats from one phase to the next
  HalfView halves[2];
  const float* valid =
      nullptr;  ///< 0 outside the picture and where a pixel has no samples, else 1; only these are fitted
  int guide_count = kFewestGuides;  ///< or kMostGuides
  const float* guides[kMostGuides] = {};
  const float* guide_variance[kMostGuides] = {};  ///< what a guide's value does not tell
  const float* edges[kEdges] = {};                ///< over the distance at which two pixels differ
  const float* edge_noise = nullptr;              ///< the squared distance that a pixel's noise brings
};

struct ReconstructionKernels {
  /// Fits the colours of half `fitted` in the windows of one row, weighted by the other half, and adds the
  /// fits to `out`, whose planes have the layout of the band. `y`: row of the centres in the planes.
  void (*fit_row)(const BandView& band, const FitView& out, int y, int fitted, float bandwidth);
};

}  // namespace gatelight::renderer

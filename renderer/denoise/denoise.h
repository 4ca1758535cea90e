#pragma once
// Denoises a picture band by band, so that memory stays bounded, and scales it to its size.

#include <optional>
#include <vector>

#include "renderer/denoise/denoiser.h"
#include "renderer/denoise/exposure.h"
#include "renderer/film/scale_down.h"

namespace gatelight::renderer {

/// A picture with noise, of which rows are read when they are needed.
struct NoisyPicture {
  int width = 0;   ///< a multiple of the factor by which it is scaled
  int height = 0;  ///< the same
  ReadRows color;
  ReadRows albedo;  ///< empty: no guides
  ReadRows normal;  ///< the same
  ReadRows alpha;   ///< 1 float a pixel; empty: none
};

/// Rows of a denoised picture.
struct DenoisedRows {
  std::vector<float> color;  ///< 3 floats a pixel, not negative
  std::vector<float> alpha;  ///< 1 float a pixel, 0 to 1; empty where the noisy picture has none
};

/// The denoised rows begin <= y < end of the scaled picture. Each is that of the whole picture but for
/// rounding, because so many rows around them are read as the filter sees. Empty where `progress` cancelled.
std::optional<DenoisedRows> denoise_rows(const Denoiser& denoiser, const NoisyPicture& picture, int begin,
                                         int end, const FilterOptions& options, const ScaleDown& scale,
                                         const DenoiseProgress& progress = {});

/// All rows, with exposure_of() the picture as FilterOptions::scale.
std::optional<DenoisedRows> denoise(const Denoiser& denoiser, const NoisyPicture& picture,
                                    FilterOptions options, const ScaleDown& scale,
                                    const DenoiseProgress& progress = {});

}  // namespace gatelight::renderer
